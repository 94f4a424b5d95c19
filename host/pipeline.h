// SPDX-License-Identifier: MIT
// Kernels made ready to run: one pipeline for each kernel and each choice of its specialization constants.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "lodestone/host/device.h"
#include "lodestone/host/pipeline_cache.h"
#include "lodestone/kernels/kernels.h"
#include "lodestone/render/backend.h"

namespace lodestone::host {

// The descriptor set layout and the push constants of passes that look alike.
struct PipelineLayout {
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  VkPipelineLayout handle = VK_NULL_HANDLE;
  std::vector<VkDescriptorType> types;  // of bindings 0..; the last is the counters
};

// How a kernel sees word and quad arrays (shaders/kernel.glsl).
enum class BufferForm : uint8_t { storage, texel, pairs, split };

bool is_texel_buffer(const render::Binding& binding, BufferForm form);

struct KernelVariant {
  BufferForm form = BufferForm::storage;
  uint32_t addressed = 0;  // split: bit i: binding i shows the addresses of its array's segments
  friend auto operator<=>(const KernelVariant&, const KernelVariant&) = default;
};

struct Pipeline {
  VkPipeline handle = VK_NULL_HANDLE;
  KernelVariant variant;
  const PipelineLayout* layout = nullptr;
  uint32_t workgroup = 1;   // what the pass asks for, or what the device can do if that is less
  bool dispatched = false;  // the driver may compile at the first dispatch
};

class PipelineLibrary {
 public:
  // `kernels`, ordered by name, must outlive the library. Segments of split arrays have 2^segment_shift
  // bytes.
  PipelineLibrary(const Device& device, PipelineCache& cache, std::span<const kernels::Kernel> kernels,
                  uint32_t segment_shift, bool counting);
  ~PipelineLibrary();
  PipelineLibrary(const PipelineLibrary&) = delete;
  PipelineLibrary& operator=(const PipelineLibrary&) = delete;

  // Made at the first call. Throws Error(device) where the device lacks what the kernel needs.
  Pipeline& get(const render::PassDecl& pass, const KernelVariant& variant,
                const std::array<uint32_t, render::pass_constants>& constants);

 private:
  using LayoutKey = std::pair<std::vector<VkDescriptorType>, uint32_t>;
  using PipelineKey = std::tuple<std::string, KernelVariant, uint32_t,
                                 std::array<uint32_t, render::pass_constants>, const PipelineLayout*>;

  const PipelineLayout& get_layout(const render::PassDecl& pass, BufferForm form);
  void check_limits(const render::PassDecl& pass, const std::vector<VkDescriptorType>& types) const;
  VkPipeline compile(const render::PassDecl& pass, const KernelVariant& variant, const PipelineLayout& layout,
                     uint32_t workgroup, const std::array<uint32_t, render::pass_constants>& constants);
  VkShaderModule load_module(const render::PassDecl& pass, BufferForm form) const;

  const Device& device_;
  PipelineCache& cache_;
  std::span<const kernels::Kernel> kernels_;
  uint32_t segment_shift_;
  bool counting_;
  std::map<LayoutKey, std::unique_ptr<PipelineLayout>> layouts_;
  std::map<PipelineKey, std::unique_ptr<Pipeline>> pipelines_;
};

}  // namespace lodestone::host
