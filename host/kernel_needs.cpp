// SPDX-License-Identifier: MIT
#include "lodestone/host/kernel_needs.h"

#include <fmt/format.h>

#include <glslang/SPIRV/spirv.hpp>

namespace lodestone::host {

namespace {

bool has_subgroup_operations(const PhysicalDevice& device, VkSubgroupFeatureFlags operations) {
  return (device.properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
         (device.properties11.subgroupSupportedOperations & operations) == operations;
}

// Empty: the device has it.
std::string unmet(spv::Capability capability, const PhysicalDevice& device) {
  const auto need = [](bool has, const char* what) { return has ? std::string() : std::string(what); };
  const auto subgroup = [&](VkSubgroupFeatureFlags operations, const char* what) {
    return need(has_subgroup_operations(device, operations), what);
  };
  switch (capability) {
    case spv::CapabilityMatrix:
    case spv::CapabilityShader:
    case spv::CapabilityImageQuery:
    case spv::CapabilitySampledBuffer:
    case spv::CapabilityImageBuffer:
      return {};
    case spv::CapabilityInt64:
      return need(device.features.shaderInt64, "64-bit integers");
    case spv::CapabilityInt16:
      return need(device.features.shaderInt16, "16-bit integers");
    case spv::CapabilityInt8:
      return need(device.features12.shaderInt8, "8-bit integers");
    case spv::CapabilityFloat64:
      return need(device.features.shaderFloat64, "64-bit floats");
    case spv::CapabilityFloat16:
      return need(device.features12.shaderFloat16, "16-bit floats");
    case spv::CapabilityInt64Atomics:
      return need(device.features12.shaderBufferInt64Atomics, "64-bit atomics");
    case spv::CapabilityStorageBuffer16BitAccess:
      return need(device.features11.storageBuffer16BitAccess, "16-bit storage");
    case spv::CapabilityStorageBuffer8BitAccess:
      return need(device.features12.storageBuffer8BitAccess, "8-bit storage");
    case spv::CapabilityPhysicalStorageBufferAddresses:
      return need(device.features12.bufferDeviceAddress, "buffer device addresses");
    case spv::CapabilityGroupNonUniform:
      return subgroup(VK_SUBGROUP_FEATURE_BASIC_BIT, "subgroups");
    case spv::CapabilityGroupNonUniformVote:
      return subgroup(VK_SUBGROUP_FEATURE_VOTE_BIT, "subgroup votes");
    case spv::CapabilityGroupNonUniformArithmetic:
      return subgroup(VK_SUBGROUP_FEATURE_ARITHMETIC_BIT, "subgroup arithmetic");
    case spv::CapabilityGroupNonUniformBallot:
      return subgroup(VK_SUBGROUP_FEATURE_BALLOT_BIT, "subgroup ballots");
    case spv::CapabilityGroupNonUniformShuffle:
      return subgroup(VK_SUBGROUP_FEATURE_SHUFFLE_BIT, "subgroup shuffles");
    case spv::CapabilityGroupNonUniformShuffleRelative:
      return subgroup(VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT, "relative subgroup shuffles");
    case spv::CapabilityGroupNonUniformClustered:
      return subgroup(VK_SUBGROUP_FEATURE_CLUSTERED_BIT, "clustered subgroup operations");
    case spv::CapabilityGroupNonUniformQuad:
      return subgroup(VK_SUBGROUP_FEATURE_QUAD_BIT, "subgroup quads");
    default:
      return fmt::format("SPIR-V capability {}", uint32_t(capability));
  }
}

}  // namespace

std::vector<std::string> find_unmet_needs(std::span<const uint32_t> module, const PhysicalDevice& device) {
  constexpr size_t header_words = 5;
  std::vector<std::string> needs;
  for (size_t i = header_words; i < module.size();) {
    const uint32_t length = module[i] >> spv::WordCountShift;
    // Capabilities come first in a module.
    if (length != 2 || (module[i] & spv::OpCodeMask) != spv::OpCapability) break;
    std::string what = unmet(spv::Capability(module[i + 1]), device);
    if (!what.empty()) needs.push_back(std::move(what));
    i += length;
  }
  return needs;
}

}  // namespace lodestone::host
