// SPDX-License-Identifier: MIT
#include "lodestone/cpu_fallback/cpu_backend.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <new>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/base/memory.h"
#include "lodestone/cpu_fallback/kernel.h"
#include "lodestone/cpu_fallback/passes/boxes.h"
#include "lodestone/cpu_fallback/passes/passes.h"
#include "lodestone/cpu_fallback/passes/trace_wide.h"
#include "lodestone/cpu_fallback/passes/wide_nodes.h"

namespace lodestone::cpu_fallback {
namespace {

using render::Buffer;
using render::BufferDesc;
using render::BufferId;

CpuPass find_pass(std::string_view kernel) {
  static const std::map<std::string_view, CpuPass> passes = {
      {"geometry_image/links", links},
      {"geometry_image/blend", blend},
      {"geometry_image/relax_begin", relax_begin},
      {"geometry_image/relax_measure", relax_measure},
      {"geometry_image/relax_move", relax_move},
      {"geometry_image/rasterise", rasterise},
      {"geometry_image/bounds_leaves", bounds_leaves},
      {"geometry_image/bounds", bounds},
      {"geometry_image/wide_nodes", wide_nodes},
      {"geometry_image/boxes_leaves", boxes_leaves},
      {"geometry_image/boxes_blocks", boxes_blocks},
      {"geometry_image/boxes", boxes},
      {"geometry_image/detail_begin", detail_begin},
      {"geometry_image/detail_measure", detail_measure},
      {"geometry_image/detail_settle", detail_settle},
      {"geometry_image/detail_end", detail_end},
      {"geometry_image/place_instances", place_instances},
      {"geometry_image/sort_keys", sort_keys},
      {"geometry_image/upper_leaves", upper_leaves},
      {"geometry_image/enter_instances", enter_instances},
      {"geometry_image/scan_blocks", scan_blocks},
      {"geometry_image/gather_rays", gather_rays},
      {"geometry_image/list_rays", list_rays},
      {"geometry_image/local_rays", local_rays},
      {"geometry_image/portion_begin", portion_begin},
      {"geometry_image/portion_enter", portion_enter},
      {"geometry_image/portion_end", portion_end},
      {"geometry_image/camera", camera},
      {"geometry_image/trace_threaded", trace_threaded},
      {"geometry_image/trace_octant", trace_octant},
      {"geometry_image/trace_wide", trace_wide},
      {"geometry_image/trace_boxes", trace_boxes},
      {"geometry_image/trace_tile", trace_tile},
      {"geometry_image/mask", mask},
      {"geometry_image/shade", shade},
      {"geometry_image/ambient", ambient},
      {"geometry_image/branch", branch},
      {"geometry_image/draw_emitters", draw_emitters},
      {"geometry_image/path", path},
      {"geometry_image/accumulate", accumulate},
      {"geometry_image/aov", aov},
      {"geometry_image/resolve", resolve},
      {"geometry_image/features", features},
      {"denoise/moments", denoise_moments},
      {"denoise/begin", denoise_begin},
      {"denoise/variance", denoise_variance},
      {"denoise/filter", denoise_filter},
      {"denoise/end", denoise_end},
  };
  const auto found = passes.find(kernel);
  if (found == passes.end()) fail(ExitCode::device, "cpu", "has no pass {}", kernel);
  return found->second;
}

// Zeroed memory on a cache-line boundary, for SIMD loads.
class Storage {
 public:
  explicit Storage(const BufferDesc& desc)
      : desc_(desc), bytes_(std::max<uint64_t>(desc.elements * desc.element_bytes, 4)) {
    const uint64_t padded = (bytes_ + 63) / 64 * 64;
    require_memory(padded, "buffer " + desc.name);
    words_ = static_cast<uint32_t*>(std::aligned_alloc(64, padded));
    if (words_ == nullptr) throw std::bad_alloc();
    std::memset(words_, 0, padded);
  }
  ~Storage() { std::free(words_); }
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;

  const BufferDesc& desc() const { return desc_; }
  uint32_t* words() const { return words_; }
  uint64_t bytes() const { return bytes_; }

  // The place of a transfer, checked against the end.
  std::byte* range(uint64_t offset, uint64_t size) const {
    if (offset > bytes_ || size > bytes_ - offset) {
      fail(ExitCode::device, desc_.name, "transfer of {} bytes at {} leaves the buffer of {}", size, offset,
           bytes_);
    }
    return reinterpret_cast<std::byte*>(words_) + offset;
  }

 private:
  BufferDesc desc_;
  uint64_t bytes_;
  uint32_t* words_;
};

class CpuBackend final : public render::Backend {
 public:
  explicit CpuBackend(const render::BackendOptions& options) : counting_(options.counters) {
    set_thread_count(options.threads);
    info_.kind = "cpu";
    info_.name = "CPU fallback (" + simd_target() + ")";
    info_.driver = "native";
    info_.api = "C++20";
    info_.max_buffer_bytes = uint64_t(1) << 40;
  }

  const render::DeviceInfo& info() const override { return info_; }

  BufferId create(const BufferDesc& desc) override {
    const BufferId id = next_++;
    buffers_.emplace(id, std::make_unique<Storage>(desc));
    allocated_ += buffers_.at(id)->bytes();
    return id;
  }

  void destroy(BufferId buffer) override {
    allocated_ -= at(buffer).bytes();
    buffers_.erase(buffer);
  }

  void upload(BufferId buffer, std::span<const std::byte> bytes, uint64_t offset) override {
    if (!bytes.empty()) std::memcpy(at(buffer).range(offset, bytes.size()), bytes.data(), bytes.size());
  }

  void download(BufferId buffer, std::span<std::byte> bytes, uint64_t offset) override {
    if (!bytes.empty()) std::memcpy(bytes.data(), at(buffer).range(offset, bytes.size()), bytes.size());
  }

  const BufferDesc& desc(BufferId buffer) const override { return at(buffer).desc(); }

  void run(const render::Dispatch& dispatch) override {
    std::vector<uint32_t*> words;
    for (const BufferId id : dispatch.buffers) words.push_back(at(id).words());
    render::PassRecord record;
    record.name = dispatch.pass->name;
    record.invocations = dispatch.invocations;
    record.counted = counting_;
    CpuDispatch call{words,     dispatch.push,   dispatch.invocations, dispatch.constants,
                     counting_, &record.counters};
    record.wall_start_ms = now_ms();
    find_pass(dispatch.pass->kernel)(call);
    record.wall_ms = now_ms() - record.wall_start_ms;
    records_.push_back(std::move(record));
  }

  std::vector<render::PassRecord> finish() override { return std::exchange(records_, {}); }
  uint64_t allocated_bytes() const override { return allocated_; }

 private:
  Storage& at(BufferId id) const {
    const auto found = buffers_.find(id);
    if (found == buffers_.end()) fail(ExitCode::device, "cpu", "buffer {} does not exist", id);
    return *found->second;
  }

  double now_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

  render::DeviceInfo info_;
  bool counting_;
  std::map<BufferId, std::unique_ptr<Storage>> buffers_;
  BufferId next_ = 1;
  uint64_t allocated_ = 0;
  std::vector<render::PassRecord> records_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void add_counters(render::Counters& sum, const render::Counters& more) {
  sum.bytes_read += more.bytes_read;
  sum.bytes_written += more.bytes_written;
  sum.rays += more.rays;
  sum.node_visits += more.node_visits;
  sum.box_tests += more.box_tests;
  sum.triangle_tests += more.triangle_tests;
  sum.lane_steps += more.lane_steps;
  sum.subgroup_steps += more.subgroup_steps;
}

std::unique_ptr<render::Backend> make_cpu_backend(const render::BackendOptions& options) {
  return std::make_unique<CpuBackend>(options);
}

}  // namespace lodestone::cpu_fallback
