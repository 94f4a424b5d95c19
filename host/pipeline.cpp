// SPDX-License-Identifier: MIT
#include "lodestone/host/pipeline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lodestone/base/error.h"
#include "lodestone/host/check.h"
#include "lodestone/host/descriptors.h"
#include "lodestone/host/kernel_needs.h"

namespace lodestone::host {

PipelineLibrary::PipelineLibrary(const Device& device, PipelineCache& cache,
                                 std::span<const kernels::Kernel> kernels, uint32_t segment_shift,
                                 bool counting)
    : device_(device), cache_(cache), kernels_(kernels), segment_shift_(segment_shift), counting_(counting) {}

PipelineLibrary::~PipelineLibrary() {
  for (const auto& [key, pipeline] : pipelines_)
    vkDestroyPipeline(device_.handle(), pipeline->handle, nullptr);
  for (const auto& [key, layout] : layouts_) {
    vkDestroyPipelineLayout(device_.handle(), layout->handle, nullptr);
    vkDestroyDescriptorSetLayout(device_.handle(), layout->set, nullptr);
  }
}

Pipeline& PipelineLibrary::get(const render::PassDecl& pass, const KernelVariant& variant,
                               const std::array<uint32_t, render::pass_constants>& constants) {
  const PipelineLayout& layout = get_layout(pass, variant.form);
  const VkPhysicalDeviceLimits& limits = device_.limits();
  const uint32_t workgroup =
      std::min({pass.workgroup, limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]});
  require(workgroup > 0, "pass {} has a workgroup of no invocations", pass.name);
  const PipelineKey key{pass.kernel, variant, workgroup, constants, &layout};
  if (const auto found = pipelines_.find(key); found != pipelines_.end()) return *found->second;
  auto pipeline = std::make_unique<Pipeline>();
  pipeline->handle = compile(pass, variant, layout, workgroup, constants);
  pipeline->variant = variant;
  pipeline->layout = &layout;
  pipeline->workgroup = workgroup;
  return *pipelines_.emplace(key, std::move(pipeline)).first->second;
}

void PipelineLibrary::check_limits(const render::PassDecl& pass,
                                   const std::vector<VkDescriptorType>& types) const {
  const VkPhysicalDeviceLimits& limits = device_.limits();
  const auto count = [&](VkDescriptorType type) {
    return uint32_t(std::count(types.begin(), types.end(), type));
  };
  const auto demand = [&](uint32_t needed, uint32_t possible, const char* what) {
    if (needed <= possible) return;
    fail(ExitCode::device, device_.name(), "pass {} needs {} {}; the device has {}: use another --device",
         pass.name, needed, what, possible);
  };
  demand(count(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER), limits.maxPerStageDescriptorStorageBuffers,
         "storage buffers");
  demand(count(VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER), limits.maxPerStageDescriptorStorageImages,
         "texel buffers");
  demand(uint32_t(types.size()), limits.maxPerStageResources, "buffers");
  demand(pass.push_bytes, limits.maxPushConstantsSize, "bytes of push constants");
}

bool is_texel_buffer(const render::Binding& binding, BufferForm form) {
  if (binding.kind == render::BindingKind::structs) return false;
  const bool pair = binding.kind == render::BindingKind::quad && binding.access == render::Access::write;
  return form == BufferForm::texel || (form == BufferForm::pairs && !pair);
}

const PipelineLayout& PipelineLibrary::get_layout(const render::PassDecl& pass, BufferForm form) {
  require(pass.push_bytes % 4 == 0, "pass {} has {} bytes of push constants, not a multiple of 4", pass.name,
          pass.push_bytes);
  require(pass.bindings.size() < DescriptorAllocator::max_bindings, "pass {} has {} bindings", pass.name,
          pass.bindings.size());
  std::vector<VkDescriptorType> types;
  for (const render::Binding& binding : pass.bindings) {
    types.push_back(is_texel_buffer(binding, form) ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                                   : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  }
  types.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);  // counters
  const LayoutKey key{types, pass.push_bytes};
  if (const auto found = layouts_.find(key); found != layouts_.end()) return *found->second;
  check_limits(pass, types);

  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const VkDescriptorType type : types) {
    bindings.push_back({uint32_t(bindings.size()), type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  auto layout = std::make_unique<PipelineLayout>();
  VkDescriptorSetLayoutCreateInfo set_info{};
  set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set_info.bindingCount = uint32_t(bindings.size());
  set_info.pBindings = bindings.data();
  device_.check(vkCreateDescriptorSetLayout(device_.handle(), &set_info, nullptr, &layout->set),
                "vkCreateDescriptorSetLayout");
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pass.push_bytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &layout->set;
  info.pushConstantRangeCount = pass.push_bytes == 0 ? 0 : 1;
  info.pPushConstantRanges = &push;
  device_.check(vkCreatePipelineLayout(device_.handle(), &info, nullptr, &layout->handle),
                "vkCreatePipelineLayout");
  layout->types = std::move(types);
  device_.set_name(layout->set, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, pass.name);
  device_.set_name(layout->handle, VK_OBJECT_TYPE_PIPELINE_LAYOUT, pass.name);
  return *layouts_.emplace(key, std::move(layout)).first->second;
}

VkShaderModule PipelineLibrary::load_module(const render::PassDecl& pass, BufferForm form) const {
  constexpr const char* suffixes[] = {"", "_texel", "_pairs", "_split"};
  const std::string name = std::string(pass.kernel) + suffixes[size_t(form)];
  const std::span<const uint32_t> words = kernels::find_kernel(kernels_, name);
  require(!words.empty(), "there is no kernel {}", name);
  const std::vector<std::string> needs = find_unmet_needs(words, device_.physical());
  if (!needs.empty()) {
    fail(ExitCode::device, device_.name(),
         "kernel {} needs {}, which the device lacks: use another --traversal or --device", pass.kernel,
         fmt::join(needs, ", "));
  }
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = words.size_bytes();
  info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  device_.check(vkCreateShaderModule(device_.handle(), &info, nullptr, &module), "vkCreateShaderModule");
  device_.set_name(module, VK_OBJECT_TYPE_SHADER_MODULE, name);
  return module;
}

VkPipeline PipelineLibrary::compile(const render::PassDecl& pass, const KernelVariant& variant,
                                    const PipelineLayout& layout, uint32_t workgroup,
                                    const std::array<uint32_t, render::pass_constants>& constants) {
  // Constant i is word i: the workgroup, whether to count, what the dispatch chose, and how arrays are split.
  std::array<uint32_t, 4 + render::pass_constants> values{workgroup, counting_ ? 1u : 0u};
  std::copy(constants.begin(), constants.end(), values.begin() + 2);
  values[2 + render::pass_constants] = variant.addressed;
  values[3 + render::pass_constants] = segment_shift_;
  std::array<VkSpecializationMapEntry, values.size()> entries{};
  for (uint32_t i = 0; i < entries.size(); ++i)
    entries[i] = {i, uint32_t(i * sizeof(uint32_t)), sizeof(uint32_t)};
  const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(), sizeof(values),
                                            values.data()};

  const VkShaderModule module = load_module(pass, variant.form);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout.handle;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      vkCreateComputePipelines(device_.handle(), cache_.handle(), 1, &info, nullptr, &pipeline);
  vkDestroyShaderModule(device_.handle(), module, nullptr);
  if (result != VK_SUCCESS) {
    fail(ExitCode::device, device_.name(), "its driver cannot compile kernel {} ({})", pass.kernel,
         result_name(result));
  }
  cache_.note_new_pipeline();
  device_.set_name(pipeline, VK_OBJECT_TYPE_PIPELINE, pass.kernel);
  return pipeline;
}

}  // namespace lodestone::host
