// SPDX-License-Identifier: MIT
#include "lodestone/host/vulkan_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/hash.h"
#include "lodestone/host/batch_queue.h"
#include "lodestone/host/buffer_table.h"
#include "lodestone/host/check.h"
#include "lodestone/host/hazards.h"
#include "lodestone/host/pipeline.h"

namespace lodestone::host {

namespace {

constexpr uint64_t staging_chunk = uint64_t(64) << 20;   // one staging buffer
constexpr uint64_t staging_limit = uint64_t(256) << 20;  // of a batch; then it is submitted

uint32_t element_bytes(render::BindingKind kind) {
  return kind == render::BindingKind::quad ? 16 : 4;
}

std::string digest_of(std::span<const kernels::Kernel> kernels) {
  ContentHash hash;
  for (const kernels::Kernel& kernel : kernels) {
    hash.add(std::string(kernel.name));
    hash.add(std::as_bytes(kernel.words));
  }
  return hash.hex();
}

class VulkanBackend final : public render::Backend {
 public:
  VulkanBackend(std::unique_ptr<Instance> instance, const PhysicalDevice& physical,
                const DeviceDetails& details, const render::BackendOptions& options,
                const HostOptions& host_options)
      : instance_(std::move(instance)),
        physical_(physical),
        info_(details),
        limits_(physical, uses_texel_buffers(physical, host_options.texel_buffers),
                host_options.texel_buffers != TexelBuffers::without_pairs, host_options.max_buffer_bytes),
        device_(*instance_, physical_),
        memory_(device_, host_options.map_device_memory),
        cache_(device_, host_options.cache_folder, digest_of(host_options.kernels)),
        pipelines_(device_, cache_, host_options.kernels, limits_.segment_shift, options.counters),
        queue_(device_, memory_, device_.has_timestamps() ? std::max(1u, host_options.passes_per_batch) : 1,
               options.counters) {}

  const render::DeviceInfo& info() const override { return info_; }
  render::BufferId create(const render::BufferDesc& desc) override;
  void destroy(render::BufferId id) override;
  void upload(render::BufferId id, std::span<const std::byte> bytes, uint64_t offset) override;
  void download(render::BufferId id, std::span<std::byte> bytes, uint64_t offset) override;
  const render::BufferDesc& desc(render::BufferId id) const override { return buffers_.get(id).desc; }
  void run(const render::Dispatch& dispatch) override;
  std::vector<render::PassRecord> finish() override;
  uint64_t allocated_bytes() const override { return memory_.allocated_bytes(); }

 private:
  // Makes the next command wait for those it depends on.
  void order(Batch& batch, std::span<const BufferUse> uses);
  void fill_with_zero(render::BufferId id);
  void write_table(render::BufferId id);
  void copy_in(BufferEntry& entry, render::BufferId id, std::span<const std::byte> bytes, uint64_t offset);
  void copy_out(BufferEntry& entry, render::BufferId id, std::span<std::byte> bytes, uint64_t offset);
  void check_dispatch(const render::Dispatch& dispatch) const;
  void check_range(const render::Dispatch& dispatch, size_t binding, const BufferEntry& entry) const;
  KernelVariant choose_variant(const render::Dispatch& dispatch) const;
  void record(Batch& batch, Pipeline& pipeline, const render::Dispatch& dispatch);
  VkDescriptorSet write_descriptors(Batch& batch, const Pipeline& pipeline, const render::Dispatch& dispatch,
                                    uint32_t slot);
  void dispatch_groups(VkCommandBuffer commands, const Pipeline& pipeline,
                       const render::Dispatch& dispatch) const;

  std::unique_ptr<Instance> instance_;
  PhysicalDevice physical_;
  DeviceDetails info_;
  ArrayLimits limits_;
  Device device_;
  MemoryAllocator memory_;
  PipelineCache cache_;
  PipelineLibrary pipelines_;
  BufferTable buffers_;
  HazardTracker hazards_;
  BatchQueue queue_;  // destroyed first: it waits for the device
};

// -------------------------------------------------------------------------------------------------- buffers

render::BufferId VulkanBackend::create(const render::BufferDesc& desc) {
  require(desc.element_bytes > 0, "buffer {} has elements of no bytes", desc.name);
  const uint64_t limit = limits_.array_bytes(desc.element_bytes);
  if (desc.elements > limit / desc.element_bytes) {
    fail(ExitCode::device, device_.name(),
         "buffer {} needs {} x {} bytes, where the device can show kernels {} bytes at most: use a lower "
         "resolution or another --device",
         desc.name, desc.elements, desc.element_bytes, limit);
  }
  // Nothing of Vulkan may be empty; fills and copies go by words.
  const uint64_t bytes = (std::max<uint64_t>(1, desc.elements) * desc.element_bytes + 3) / 4 * 4;
  auto array = std::make_unique<DeviceArray>(device_, memory_, limits_, bytes, desc.element_bytes, desc.name);
  const render::BufferId id = buffers_.add({desc, std::move(array), 0});
  fill_with_zero(id);
  write_table(id);
  return id;
}

void VulkanBackend::fill_with_zero(render::BufferId id) {
  BufferEntry& entry = buffers_.get(id);
  if (entry.array->is_mapped()) {
    for (const auto& buffer : entry.array->buffers()) std::memset(buffer->mapped(), 0, buffer->bytes());
    return;
  }
  Batch& batch = queue_.recording();
  const BufferUse use{id, false, true};
  order(batch, {&use, 1});
  for (const auto& buffer : entry.array->buffers())
    vkCmdFillBuffer(batch.commands(), buffer->handle(), 0, VK_WHOLE_SIZE, 0);
  entry.last_batch = batch.serial();
}

void VulkanBackend::write_table(render::BufferId id) {
  BufferEntry& entry = buffers_.get(id);
  DeviceBuffer* const table = entry.array->table();
  if (table == nullptr) return;
  const std::vector<VkDeviceAddress> addresses = entry.array->segment_addresses();
  Batch& batch = queue_.recording();
  const BufferUse use{id, false, true};
  order(batch, {&use, 1});
  vkCmdUpdateBuffer(batch.commands(), table->handle(), 0, addresses.size() * sizeof(VkDeviceAddress),
                    addresses.data());
  entry.last_batch = batch.serial();
}

void VulkanBackend::destroy(render::BufferId id) {
  BufferEntry entry = buffers_.take(id);
  if (entry.last_batch <= queue_.completed()) return;
  // The youngest batch finishes last.
  for (auto& buffer : entry.array->release()) queue_.youngest().keep(std::move(buffer));
}

void VulkanBackend::upload(render::BufferId id, std::span<const std::byte> bytes, uint64_t offset) {
  BufferEntry& entry = buffers_.get(id);
  require(offset <= entry.bytes() && bytes.size() <= entry.bytes() - offset,
          "{} bytes at {} do not fit into buffer {} of {} bytes", bytes.size(), offset, entry.desc.name,
          entry.bytes());
  if (bytes.empty()) return;
  const bool idle = entry.last_batch <= queue_.completed();
  if (!idle || !entry.array->is_mapped()) {
    copy_in(entry, id, bytes, offset);
    return;
  }
  entry.array->for_each_piece(offset, bytes.size(),
                              [&](DeviceBuffer& buffer, uint64_t within, uint64_t done, uint64_t size) {
                                std::memcpy(buffer.mapped() + within, bytes.data() + done, size);
                              });
}

void VulkanBackend::download(render::BufferId id, std::span<std::byte> bytes, uint64_t offset) {
  BufferEntry& entry = buffers_.get(id);
  require(offset <= entry.bytes() && bytes.size() <= entry.bytes() - offset,
          "{} bytes at {} lie outside buffer {} of {} bytes", bytes.size(), offset, entry.desc.name,
          entry.bytes());
  if (!entry.array->is_mapped()) {
    copy_out(entry, id, bytes, offset);
    return;
  }
  queue_.wait_all();
  hazards_.clear();
  entry.array->for_each_piece(offset, bytes.size(),
                              [&](DeviceBuffer& buffer, uint64_t within, uint64_t done, uint64_t size) {
                                std::memcpy(bytes.data() + done, buffer.mapped() + within, size);
                              });
}

void VulkanBackend::copy_in(BufferEntry& entry, render::BufferId id, std::span<const std::byte> bytes,
                            uint64_t offset) {
  while (!bytes.empty()) {
    const size_t chunk = std::min<uint64_t>(bytes.size(), staging_chunk);
    auto staging = std::make_unique<DeviceBuffer>(device_, memory_, chunk, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                  MemoryUse::upload, "upload to " + entry.desc.name);
    std::memcpy(staging->mapped(), bytes.data(), chunk);
    Batch& batch = queue_.recording();
    const BufferUse use{id, false, true};
    order(batch, {&use, 1});
    entry.array->for_each_piece(
        offset, chunk, [&](DeviceBuffer& buffer, uint64_t within, uint64_t done, uint64_t size) {
          const VkBufferCopy region{done, within, size};
          vkCmdCopyBuffer(batch.commands(), staging->handle(), buffer.handle(), 1, &region);
        });
    entry.last_batch = batch.serial();
    batch.keep(std::move(staging));
    if (batch.kept_bytes() >= staging_limit) queue_.submit();
    bytes = bytes.subspan(chunk);
    offset += chunk;
  }
}

void VulkanBackend::copy_out(BufferEntry& entry, render::BufferId id, std::span<std::byte> bytes,
                             uint64_t offset) {
  while (!bytes.empty()) {
    const size_t chunk = std::min<uint64_t>(bytes.size(), staging_chunk);
    const DeviceBuffer staging(device_, memory_, chunk, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback,
                               "download of " + entry.desc.name);
    Batch& batch = queue_.recording();
    const BufferUse use{id, true, false};
    order(batch, {&use, 1});
    entry.array->for_each_piece(
        offset, chunk, [&](DeviceBuffer& buffer, uint64_t within, uint64_t done, uint64_t size) {
          const VkBufferCopy region{within, done, size};
          vkCmdCopyBuffer(batch.commands(), buffer.handle(), staging.handle(), 1, &region);
        });
    entry.last_batch = batch.serial();
    queue_.wait_all();
    hazards_.clear();
    std::memcpy(bytes.data(), staging.mapped(), chunk);
    bytes = bytes.subspan(chunk);
    offset += chunk;
  }
}

void VulkanBackend::order(Batch& batch, std::span<const BufferUse> uses) {
  if (!hazards_.enter(uses)) return;
  constexpr VkPipelineStageFlags stages =
      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                          VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  vkCmdPipelineBarrier(batch.commands(), stages, stages, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

// -------------------------------------------------------------------------------------------------- passes

void VulkanBackend::check_dispatch(const render::Dispatch& dispatch) const {
  require(dispatch.pass != nullptr, "a dispatch without a pass");
  const render::PassDecl& pass = *dispatch.pass;
  require(dispatch.buffers.size() == pass.bindings.size(), "pass {} has {} bindings, the dispatch {} buffers",
          pass.name, pass.bindings.size(), dispatch.buffers.size());
  require(dispatch.push.size() == pass.push_bytes, "pass {} has {} bytes of push constants, the dispatch {}",
          pass.name, pass.push_bytes, dispatch.push.size());
  for (size_t i = 0; i < dispatch.buffers.size(); ++i)
    check_range(dispatch, i, buffers_.get(dispatch.buffers[i]));
}

void VulkanBackend::check_range(const render::Dispatch& dispatch, size_t binding,
                                const BufferEntry& entry) const {
  const render::BindingKind kind = dispatch.pass->bindings[binding].kind;
  const uint64_t bytes = entry.array->bytes();
  if (kind != render::BindingKind::structs) {
    require(bytes % element_bytes(kind) == 0, "buffer {} of {} bytes cannot be bound as elements of {} bytes",
            entry.desc.name, bytes, element_bytes(kind));
  } else if (bytes > limits_.storage_bytes) {
    fail(ExitCode::device, device_.name(),
         "buffer {} has {} bytes, of which pass {} can see {} at most on this device: use a lower resolution "
         "or another --device",
         entry.desc.name, bytes, dispatch.pass->name, limits_.storage_bytes);
  }
}

// The fastest variant that can see all arrays whole, or the one that gets the addresses of those it cannot.
KernelVariant VulkanBackend::choose_variant(const render::Dispatch& dispatch) const {
  bool fits_texel_buffers = limits_.texel_buffers, fits_pairs = limits_.pairs;
  uint32_t addressed = 0;
  for (size_t i = 0; i < dispatch.buffers.size(); ++i) {
    const render::BindingKind kind = dispatch.pass->bindings[i].kind;
    if (kind == render::BindingKind::structs) continue;
    const uint64_t bytes = buffers_.get(dispatch.buffers[i]).array->bytes();
    if (bytes > limits_.texel_bytes(element_bytes(kind))) fits_texel_buffers = false;
    if (bytes <= limits_.storage_bytes) continue;
    addressed |= 1u << i;
    if (!is_texel_buffer(dispatch.pass->bindings[i], BufferForm::pairs)) fits_pairs = false;
  }
  const auto stored = std::count_if(
      dispatch.pass->bindings.begin(), dispatch.pass->bindings.end(),
      [](const render::Binding& binding) { return !is_texel_buffer(binding, BufferForm::pairs); });
  const uint32_t with_counters = static_cast<uint32_t>(stored) + 1;
  if (with_counters > device_.limits().maxPerStageDescriptorStorageBuffers) fits_pairs = false;
  if (fits_texel_buffers) return {fits_pairs ? BufferForm::pairs : BufferForm::texel, 0};
  if (addressed == 0) return {BufferForm::storage, 0};
  if (limits_.has_addresses) return {BufferForm::split, addressed};
  fail(ExitCode::device, device_.name(),
       "pass {} has arrays that only texel buffers can show and others that only storage buffers can: use a "
       "lower resolution or another --device",
       dispatch.pass->name);
}

void VulkanBackend::run(const render::Dispatch& dispatch) {
  check_dispatch(dispatch);
  Pipeline& pipeline = pipelines_.get(*dispatch.pass, choose_variant(dispatch), dispatch.constants);
  record(queue_.recording(), pipeline, dispatch);
  if (!queue_.recording().is_full()) return;
  // Without timestamps the host's clock is all there is: one pass at a time.
  if (device_.has_timestamps()) {
    queue_.submit();
  } else {
    queue_.wait_all();
  }
}

void VulkanBackend::record(Batch& batch, Pipeline& pipeline, const render::Dispatch& dispatch) {
  const render::PassDecl& pass = *dispatch.pass;
  std::vector<BufferUse> uses;
  for (size_t i = 0; i < dispatch.buffers.size(); ++i) {
    const render::Access access = pass.bindings[i].access;
    uses.push_back({dispatch.buffers[i], access != render::Access::write, access != render::Access::read});
    buffers_.get(dispatch.buffers[i]).last_batch = batch.serial();
  }
  render::PassRecord pass_record;
  pass_record.name = pass.name;
  pass_record.invocations = dispatch.invocations;
  pass_record.first = !pipeline.dispatched;
  const uint32_t slot = batch.add_pass(std::move(pass_record));
  const VkDescriptorSet set = write_descriptors(batch, pipeline, dispatch, slot);

  const VkCommandBuffer commands = batch.commands();
  device_.begin_label(commands, pass.name);
  order(batch, uses);
  batch.profiler().start(commands, slot);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout->handle, 0, 1, &set, 0,
                          nullptr);
  if (pass.push_bytes > 0) {
    vkCmdPushConstants(commands, pipeline.layout->handle, VK_SHADER_STAGE_COMPUTE_BIT, 0, pass.push_bytes,
                       dispatch.push.data());
  }
  if (dispatch.invocations > 0) {
    dispatch_groups(commands, pipeline, dispatch);
    pipeline.dispatched = true;
  }
  batch.profiler().stop(commands, slot);
  device_.end_label(commands);
}

VkDescriptorSet VulkanBackend::write_descriptors(Batch& batch, const Pipeline& pipeline,
                                                 const render::Dispatch& dispatch, uint32_t slot) {
  const VkDescriptorSet set = batch.descriptors().allocate(pipeline.layout->set);
  device_.set_name(set, VK_OBJECT_TYPE_DESCRIPTOR_SET, dispatch.pass->name);
  const size_t count = pipeline.layout->types.size();
  std::vector<VkDescriptorBufferInfo> ranges(count);
  std::vector<VkBufferView> views(count);
  std::vector<VkWriteDescriptorSet> writes(count);
  for (size_t i = 0; i < count; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set;
    writes[i].dstBinding = uint32_t(i);
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = pipeline.layout->types[i];
    writes[i].pBufferInfo = &ranges[i];
    writes[i].pTexelBufferView = &views[i];
    if (i == dispatch.buffers.size()) {
      ranges[i] = batch.profiler().counters_of(slot);
      continue;
    }
    DeviceArray& array = *buffers_.get(dispatch.buffers[i]).array;
    if ((pipeline.variant.addressed >> i & 1u) != 0) {
      ranges[i] = {array.table()->handle(), 0, VK_WHOLE_SIZE};
    } else if (writes[i].descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) {
      ranges[i] = {array.whole().handle(), 0, VK_WHOLE_SIZE};
    } else {
      const bool quads = dispatch.pass->bindings[i].kind == render::BindingKind::quad;
      views[i] = quads ? array.whole().quad_view() : array.whole().word_view();
    }
  }
  vkUpdateDescriptorSets(device_.handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
  return set;
}

void VulkanBackend::dispatch_groups(VkCommandBuffer commands, const Pipeline& pipeline,
                                    const render::Dispatch& dispatch) const {
  // More workgroups than a row can have are laid out in rows of equal length, the last one not always full.
  // Kernels count on across rows and return where they are past the end.
  const uint64_t groups = (uint64_t(dispatch.invocations) + pipeline.workgroup - 1) / pipeline.workgroup;
  const uint64_t row_limit = device_.limits().maxComputeWorkGroupCount[0];
  const uint64_t rows = (groups + row_limit - 1) / row_limit;
  const uint64_t row = (groups + rows - 1) / rows;
  require(rows * row * pipeline.workgroup <= std::numeric_limits<uint32_t>::max(),
          "pass {} has {} invocations, more than an index of 32 bits can count in rows", dispatch.pass->name,
          dispatch.invocations);
  if (rows > device_.limits().maxComputeWorkGroupCount[1]) {
    fail(ExitCode::device, device_.name(), "pass {} needs {} workgroups, where {} x {} are possible",
         dispatch.pass->name, groups, row_limit, device_.limits().maxComputeWorkGroupCount[1]);
  }
  vkCmdDispatch(commands, uint32_t(row), uint32_t(rows), 1);
}

std::vector<render::PassRecord> VulkanBackend::finish() {
  queue_.wait_all();
  hazards_.clear();
  fail_on_messages(device_.name(), instance_->messages().take());
  return queue_.take_records();
}

}  // namespace

std::unique_ptr<render::Backend> make_backend(const std::string& selector,
                                              const render::BackendOptions& options,
                                              const HostOptions& host_options) {
  auto instance = std::make_unique<Instance>(options.validate);
  std::vector<PhysicalDevice> physical;
  std::vector<DeviceDetails> details;
  for (VkPhysicalDevice handle : instance->physical_devices()) {
    physical.push_back(query_physical_device(handle));
    const bool texel = host_options.texel_buffers != TexelBuffers::never && physical.back().texel_formats &&
                       uses_texel_buffers(physical.back(), host_options.texel_buffers);
    details.push_back(describe_device(physical.back(), uint32_t(details.size()), texel));
  }
  const uint32_t chosen = select_device(details, selector);
  return std::make_unique<VulkanBackend>(std::move(instance), physical[chosen], details[chosen], options,
                                         host_options);
}

}  // namespace lodestone::host
