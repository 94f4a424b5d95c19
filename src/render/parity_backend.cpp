// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <map>

#include "lodestone/base/error.h"
#include "lodestone/render/renderer.h"

namespace lodestone::render {

// A buffer has the same id in all three; the device's contents lead, the reference's are made equal before
// each pass.
struct ParityBackend::State {
  Backend* device = nullptr;
  Backend* reference = nullptr;
  std::optional<Fault> fault;
  bool fault_done = false;
  std::map<BufferId, std::pair<BufferId, BufferId>> ids;
  BufferId next = 1;
  std::vector<PassDifference> differences;

  uint64_t bytes(BufferId buffer) const {
    const BufferDesc& desc = device->desc(ids.at(buffer).first);
    return desc.elements * desc.element_bytes;
  }

  std::vector<uint32_t> words(Backend& backend, BufferId id, uint64_t count) const {
    std::vector<uint32_t> data(count / 4);
    if (count > 0) backend.download(id, std::as_writable_bytes(std::span(data)), 0);
    return data;
  }

  // Flips the bit on the device; again, and it is as before.
  void break_device(const Dispatch& dispatch) {
    for (size_t i = 0; i < dispatch.buffers.size(); ++i) {
      if (dispatch.pass->bindings[i].access == Access::read || bytes(dispatch.buffers[i]) == 0) continue;
      const BufferId id = ids.at(dispatch.buffers[i]).first;
      const uint64_t word = std::min<uint64_t>(fault->bit / 32, bytes(dispatch.buffers[i]) / 4 - 1);
      uint32_t value = 0;
      const auto place = std::as_writable_bytes(std::span(&value, 1));
      device->download(id, place, 4 * word);
      value ^= 1u << (fault->bit % 32);
      device->upload(id, place, 4 * word);
      return;
    }
  }

  void compare(const Dispatch& dispatch, size_t binding) {
    const BufferId buffer = dispatch.buffers[binding];
    const auto [device_id, reference_id] = ids.at(buffer);
    const std::vector<uint32_t> a = words(*device, device_id, bytes(buffer));
    const std::vector<uint32_t> b = words(*reference, reference_id, bytes(buffer));
    const std::string pass = dispatch.pass->name, name = device->desc(device_id).name;
    auto row = std::find_if(differences.begin(), differences.end(),
                            [&](const PassDifference& d) { return d.pass == pass && d.buffer == name; });
    if (row == differences.end()) {
      differences.push_back({});
      row = differences.end() - 1;
      row->pass = pass;
      row->buffer = name;
    }
    ++row->dispatches;
    row->words += a.size();
    if (a == b) return;
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i] == b[i]) continue;
      if (row->different++ == 0) {
        row->first = i;
        row->device_value = a[i];
        row->reference_value = b[i];
      }
    }
  }
};

ParityBackend::ParityBackend(Backend& device, Backend& reference, std::optional<Fault> fault)
    : state_(std::make_unique<State>()) {
  state_->device = &device;
  state_->reference = &reference;
  state_->fault = std::move(fault);
}

ParityBackend::~ParityBackend() = default;

const DeviceInfo& ParityBackend::info() const {
  return state_->device->info();
}

BufferId ParityBackend::create(const BufferDesc& desc) {
  const BufferId id = state_->next++;
  state_->ids[id] = {state_->device->create(desc), state_->reference->create(desc)};
  return id;
}

void ParityBackend::destroy(BufferId buffer) {
  const auto [device_id, reference_id] = state_->ids.at(buffer);
  state_->device->destroy(device_id);
  state_->reference->destroy(reference_id);
  state_->ids.erase(buffer);
}

void ParityBackend::upload(BufferId buffer, std::span<const std::byte> bytes, uint64_t offset_bytes) {
  const auto [device_id, reference_id] = state_->ids.at(buffer);
  state_->device->upload(device_id, bytes, offset_bytes);
  state_->reference->upload(reference_id, bytes, offset_bytes);
}

void ParityBackend::download(BufferId buffer, std::span<std::byte> bytes, uint64_t offset_bytes) {
  state_->device->download(state_->ids.at(buffer).first, bytes, offset_bytes);
}

const BufferDesc& ParityBackend::desc(BufferId buffer) const {
  return state_->device->desc(state_->ids.at(buffer).first);
}

void ParityBackend::run(const Dispatch& dispatch) {
  State& s = *state_;
  std::vector<BufferId> device_ids, reference_ids;
  for (const BufferId buffer : dispatch.buffers) {
    const auto [device_id, reference_id] = s.ids.at(buffer);
    device_ids.push_back(device_id);
    reference_ids.push_back(reference_id);
    // What the device has before the pass, in every buffer of it: a pass may write only part of one.
    const std::vector<uint32_t> data = s.words(*s.device, device_id, s.bytes(buffer));
    if (!data.empty()) s.reference->upload(reference_id, std::as_bytes(std::span(data)), 0);
  }
  Dispatch on_device = dispatch, on_reference = dispatch;
  on_device.buffers = device_ids;
  on_reference.buffers = reference_ids;
  s.device->run(on_device);
  s.reference->run(on_reference);
  const bool faulty = s.fault && !s.fault_done && s.fault->pass == dispatch.pass->name;
  if (faulty) s.break_device(dispatch);
  for (size_t i = 0; i < dispatch.buffers.size(); ++i) {
    if (dispatch.pass->bindings[i].access != Access::read) s.compare(dispatch, i);
  }
  // What follows must not run on with it: it may be an index.
  if (faulty) {
    s.break_device(dispatch);
    s.fault_done = true;
  }
}

std::vector<PassRecord> ParityBackend::finish() {
  state_->reference->finish();
  return state_->device->finish();
}

uint64_t ParityBackend::allocated_bytes() const {
  return state_->device->allocated_bytes();
}

const std::vector<PassDifference>& ParityBackend::differences() const {
  return state_->differences;
}

}  // namespace lodestone::render
