// SPDX-License-Identifier: MIT
#include "arithmetic_rules.h"

#include <fmt/format.h>
#include <glslang/SPIRV/GLSL.std.450.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <unordered_set>

namespace lodestone::spirv {

namespace {

struct BuiltIn {
  GLSLstd450 code;
  std::string_view name;
  bool portable;
};

// Measured on lavapipe 22.3 and SwiftShader; what is missing here is not portable either.
constexpr auto built_ins = std::to_array<BuiltIn>({
    {GLSLstd450RoundEven, "RoundEven", true},
    {GLSLstd450Trunc, "Trunc", true},
    {GLSLstd450FAbs, "FAbs", true},
    {GLSLstd450SAbs, "SAbs", true},
    {GLSLstd450SSign, "SSign", true},
    {GLSLstd450Floor, "Floor", true},
    {GLSLstd450Ceil, "Ceil", true},
    {GLSLstd450Sqrt, "Sqrt", true},
    {GLSLstd450UMin, "UMin", true},
    {GLSLstd450SMin, "SMin", true},
    {GLSLstd450UMax, "UMax", true},
    {GLSLstd450SMax, "SMax", true},
    {GLSLstd450UClamp, "UClamp", true},
    {GLSLstd450SClamp, "SClamp", true},
    {GLSLstd450FindILsb, "FindILsb", true},
    {GLSLstd450FindSMsb, "FindSMsb", true},
    {GLSLstd450FindUMsb, "FindUMsb", true},
    {GLSLstd450Round, "Round", false},
    {GLSLstd450FSign, "FSign", false},
    {GLSLstd450Fract, "Fract", false},
    {GLSLstd450Sin, "Sin", false},
    {GLSLstd450Cos, "Cos", false},
    {GLSLstd450Tan, "Tan", false},
    {GLSLstd450Asin, "Asin", false},
    {GLSLstd450Acos, "Acos", false},
    {GLSLstd450Atan, "Atan", false},
    {GLSLstd450Atan2, "Atan2", false},
    {GLSLstd450Pow, "Pow", false},
    {GLSLstd450Exp, "Exp", false},
    {GLSLstd450Log, "Log", false},
    {GLSLstd450Exp2, "Exp2", false},
    {GLSLstd450Log2, "Log2", false},
    {GLSLstd450InverseSqrt, "InverseSqrt", false},
    {GLSLstd450Determinant, "Determinant", false},
    {GLSLstd450MatrixInverse, "MatrixInverse", false},
    {GLSLstd450Modf, "Modf", false},
    {GLSLstd450ModfStruct, "ModfStruct", false},
    {GLSLstd450FMin, "FMin", false},
    {GLSLstd450FMax, "FMax", false},
    {GLSLstd450FClamp, "FClamp", false},
    {GLSLstd450FMix, "FMix", false},
    {GLSLstd450Step, "Step", false},
    {GLSLstd450SmoothStep, "SmoothStep", false},
    {GLSLstd450Fma, "Fma", false},
    {GLSLstd450Frexp, "Frexp", false},
    {GLSLstd450FrexpStruct, "FrexpStruct", false},
    {GLSLstd450Ldexp, "Ldexp", false},
    {GLSLstd450PackHalf2x16, "PackHalf2x16", false},
    {GLSLstd450UnpackHalf2x16, "UnpackHalf2x16", false},
    {GLSLstd450PackUnorm4x8, "PackUnorm4x8", false},
    {GLSLstd450UnpackUnorm4x8, "UnpackUnorm4x8", false},
    {GLSLstd450Length, "Length", false},
    {GLSLstd450Distance, "Distance", false},
    {GLSLstd450Cross, "Cross", false},
    {GLSLstd450Normalize, "Normalize", false},
    {GLSLstd450FaceForward, "FaceForward", false},
    {GLSLstd450Reflect, "Reflect", false},
    {GLSLstd450Refract, "Refract", false},
    {GLSLstd450NMin, "NMin", false},
    {GLSLstd450NMax, "NMax", false},
    {GLSLstd450NClamp, "NClamp", false},
});

struct CoreOp {
  spv::Op op;
  std::string_view why;
};

constexpr std::string_view order_of_sum = "the order of its sums differs between devices";
constexpr std::string_view order_of_lanes = "its result depends on the order of the lanes";
constexpr std::string_view filtering = "filtering differs between devices; fetch the texels and blend them";

constexpr auto rejected_ops = std::to_array<CoreOp>({
    {spv::OpMatrixTimesVector, order_of_sum},
    {spv::OpVectorTimesMatrix, order_of_sum},
    {spv::OpMatrixTimesMatrix, order_of_sum},
    {spv::OpFRem, "its accuracy differs between devices"},
    {spv::OpQuantizeToF16, "its rounding differs between devices"},
    {spv::OpAtomicFAddEXT, order_of_lanes},
    {spv::OpAtomicFMinEXT, "min and max of -0 and NaN differ between devices"},
    {spv::OpAtomicFMaxEXT, "min and max of -0 and NaN differ between devices"},
    {spv::OpGroupNonUniformFAdd, order_of_lanes},
    {spv::OpGroupNonUniformFMul, order_of_lanes},
    {spv::OpGroupNonUniformFMin, order_of_lanes},
    {spv::OpGroupNonUniformFMax, order_of_lanes},
    {spv::OpImageSampleImplicitLod, filtering},
    {spv::OpImageSampleExplicitLod, filtering},
    {spv::OpImageSampleDrefImplicitLod, filtering},
    {spv::OpImageSampleDrefExplicitLod, filtering},
    {spv::OpImageSampleProjImplicitLod, filtering},
    {spv::OpImageSampleProjExplicitLod, filtering},
    {spv::OpImageSampleProjDrefImplicitLod, filtering},
    {spv::OpImageSampleProjDrefExplicitLod, filtering},
    {spv::OpImageSparseSampleImplicitLod, filtering},
    {spv::OpImageSparseSampleExplicitLod, filtering},
    {spv::OpImageGather, filtering},
    {spv::OpImageDrefGather, filtering},
});

constexpr auto float_ops = std::to_array<spv::Op>({
    spv::OpFNegate,
    spv::OpFAdd,
    spv::OpFSub,
    spv::OpFMul,
    spv::OpFDiv,
    spv::OpFMod,
    spv::OpVectorTimesScalar,
    spv::OpMatrixTimesScalar,
    spv::OpOuterProduct,
    spv::OpDot,
});

bool is_float_op(spv::Op op) {
  return std::find(float_ops.begin(), float_ops.end(), op) != float_ops.end();
}

// Walks a module once and collects what breaks the rules.
class Inspector {
 public:
  explicit Inspector(const Module& module) : module_(module) {}

  std::vector<std::string> run() {
    module_.for_each([&](const Instruction& instruction) { visit(instruction); });
    return std::move(findings_);
  }

 private:
  void visit(const Instruction& instruction) {
    const auto& words = instruction.words;
    switch (instruction.op) {
      case spv::OpString:
        strings_[words[1]] = read_string(words, 2);
        return;
      case spv::OpLine:
        line_ = fmt::format("{}:{}", strings_[words[1]], words[2]);
        return;
      case spv::OpNoLine:
        line_.clear();
        return;
      case spv::OpExtInstImport:
        if (read_string(words, 2) == "GLSL.std.450") built_in_set_ = words[1];
        return;
      case spv::OpFunction:
        function_ = module_.name_of(words[2]);
        return;
      case spv::OpTypeFloat:
        floats_.insert(words[1]);
        return;
      case spv::OpTypeVector:
      case spv::OpTypeMatrix:
        if (floats_.contains(words[2])) floats_.insert(words[1]);
        return;
      case spv::OpExtInst:
        visit_built_in(instruction);
        return;
      default:
        break;
    }
    note_constant(instruction);
    visit_core(instruction);
  }

  // Remembers float constants with a component that is zero.
  void note_constant(const Instruction& instruction) {
    const auto& words = instruction.words;
    if (instruction.op == spv::OpConstant && floats_.contains(words[1])) {
      uint32_t magnitude = words.back() & 0x7fffffffu;
      for (size_t i = 3; i + 1 < words.size(); ++i) magnitude |= words[i];
      if (magnitude == 0) zeros_.insert(words[2]);
    } else if (instruction.op == spv::OpConstantNull && floats_.contains(words[1])) {
      zeros_.insert(words[2]);
    } else if (instruction.op == spv::OpConstantComposite && floats_.contains(words[1])) {
      if (std::any_of(words.begin() + 3, words.end(), [&](uint32_t id) { return zeros_.contains(id); })) {
        zeros_.insert(words[2]);
      }
    }
  }

  void visit_core(const Instruction& instruction) {
    const auto& words = instruction.words;
    const auto rejected = std::find_if(rejected_ops.begin(), rejected_ops.end(),
                                       [&](const CoreOp& entry) { return entry.op == instruction.op; });
    if (rejected != rejected_ops.end()) {
      report(words[2], op_name(instruction.op), rejected->why);
      return;
    }
    if (!is_float_op(instruction.op)) return;
    if (std::any_of(words.begin() + 3, words.end(), [&](uint32_t id) { return zeros_.contains(id); })) {
      report(
          words[2], op_name(instruction.op),
          "an operand is a constant zero, which lavapipe folds without regard to the sign of zero and NaN");
    }
  }

  void visit_built_in(const Instruction& instruction) {
    const auto& words = instruction.words;
    if (words[3] != built_in_set_) return;  // debug information
    const auto found = std::find_if(built_ins.begin(), built_ins.end(),
                                    [&](const BuiltIn& entry) { return uint32_t(entry.code) == words[4]; });
    if (found != built_ins.end() && found->portable) return;
    const std::string name =
        found == built_ins.end() ? fmt::format("number {}", words[4]) : std::string(found->name);
    report(words[2], fmt::format("GLSL.std.450 {}", name),
           "its bits differ between devices; write it out with + - * / sqrt floor and selects");
  }

  static std::string op_name(spv::Op op) {
    switch (op) {
      case spv::OpFNegate:
        return "OpFNegate";
      case spv::OpFAdd:
        return "OpFAdd";
      case spv::OpFSub:
        return "OpFSub";
      case spv::OpFMul:
        return "OpFMul";
      case spv::OpFDiv:
        return "OpFDiv";
      case spv::OpFMod:
        return "OpFMod";
      case spv::OpFRem:
        return "OpFRem";
      case spv::OpVectorTimesScalar:
        return "OpVectorTimesScalar";
      case spv::OpMatrixTimesScalar:
        return "OpMatrixTimesScalar";
      case spv::OpMatrixTimesVector:
        return "OpMatrixTimesVector";
      case spv::OpVectorTimesMatrix:
        return "OpVectorTimesMatrix";
      case spv::OpMatrixTimesMatrix:
        return "OpMatrixTimesMatrix";
      case spv::OpOuterProduct:
        return "OpOuterProduct";
      case spv::OpDot:
        return "OpDot";
      case spv::OpQuantizeToF16:
        return "OpQuantizeToF16";
      case spv::OpImageGather:
      case spv::OpImageDrefGather:
        return "OpImage...Gather";
      case spv::OpAtomicFAddEXT:
      case spv::OpAtomicFMinEXT:
      case spv::OpAtomicFMaxEXT:
        return "OpAtomicF...";
      case spv::OpGroupNonUniformFAdd:
      case spv::OpGroupNonUniformFMul:
      case spv::OpGroupNonUniformFMin:
      case spv::OpGroupNonUniformFMax:
        return "OpGroupNonUniformF...";
      default:
        return "OpImageSample...";
    }
  }

  void report(uint32_t id, const std::string& what, std::string_view why) {
    const std::string place = line_.empty() ? std::string() : fmt::format(" at {}", line_);
    findings_.push_back(fmt::format("%{} = {} in {}{}: {}", id, what, function_, place, why));
  }

  const Module& module_;
  std::vector<std::string> findings_;
  std::unordered_map<uint32_t, std::string> strings_;
  std::unordered_set<uint32_t> floats_, zeros_;
  uint32_t built_in_set_ = 0;
  std::string line_, function_ = "the module";
};

// The sections of a module that come before its annotations.
bool precedes_annotations(spv::Op op) {
  switch (op) {
    case spv::OpCapability:
    case spv::OpExtension:
    case spv::OpExtInstImport:
    case spv::OpMemoryModel:
    case spv::OpEntryPoint:
    case spv::OpExecutionMode:
    case spv::OpExecutionModeId:
    case spv::OpString:
    case spv::OpSource:
    case spv::OpSourceContinued:
    case spv::OpSourceExtension:
    case spv::OpName:
    case spv::OpMemberName:
    case spv::OpModuleProcessed:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::vector<std::string> find_unportable(const Module& module) {
  return Inspector(module).run();
}

std::vector<uint32_t> forbid_contraction(const Module& module) {
  std::unordered_set<uint32_t> decorated;
  std::vector<uint32_t> decorations;
  std::optional<size_t> annotations;
  module.for_each([&](const Instruction& instruction) {
    const auto& words = instruction.words;
    if (!annotations && !precedes_annotations(instruction.op)) annotations = instruction.offset;
    if (instruction.op == spv::OpDecorate && words[2] == spv::DecorationNoContraction)
      decorated.insert(words[1]);
    if (is_float_op(instruction.op) && decorated.insert(words[2]).second) {
      constexpr uint32_t length = 3;
      decorations.insert(decorations.end(), {length << spv::WordCountShift | spv::OpDecorate, words[2],
                                             spv::DecorationNoContraction});
    }
  });
  std::vector<uint32_t> words(module.words().begin(), module.words().end());
  const size_t place = annotations.value_or(words.size());
  words.insert(words.begin() + std::ptrdiff_t(place), decorations.begin(), decorations.end());
  return words;
}

}  // namespace lodestone::spirv
