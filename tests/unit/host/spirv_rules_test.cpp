// SPDX-License-Identifier: MIT
// The rules of one arithmetic, on modules small enough to write by hand and on the kernels as they ship.
#include <glslang/SPIRV/GLSL.std.450.h>
#include <gtest/gtest.h>

#include <bit>
#include <stdexcept>
#include <unordered_set>

#include "arithmetic_rules.h"
#include "lodestone/kernels/kernels.h"
#include "spirv_module.h"

namespace lodestone::test_kernels {
std::span<const kernels::Kernel> all_kernels();
}

namespace lodestone::spirv {
namespace {

enum Id : uint32_t {
  built_ins = 1,
  float_type,
  vector_type,
  zero,
  two,
  zero_vector,
  function,
  label,
  x,
  y,
  result
};

// A module of one function whose body is given; the rules look at nothing else.
class Builder {
 public:
  Builder() : words_{spv::MagicNumber, 0x00010500u, 0, 100, 0} {
    add(spv::OpExtInstImport, built_ins, "GLSL.std.450");
    add(spv::OpName, function, "shade");
    add(spv::OpTypeFloat, {float_type, 32});
    add(spv::OpTypeVector, {vector_type, float_type, 3});
    add(spv::OpConstant, {float_type, zero, std::bit_cast<uint32_t>(-0.0f)});
    add(spv::OpConstant, {float_type, two, std::bit_cast<uint32_t>(2.0f)});
    add(spv::OpConstantComposite, {vector_type, zero_vector, two, zero, two});
    add(spv::OpFunction, {float_type, function, 0, 0});
    add(spv::OpLabel, {label});
  }
  Builder& add(spv::Op op, std::vector<uint32_t> operands) {
    words_.push_back(uint32_t(operands.size() + 1) << spv::WordCountShift | op);
    words_.insert(words_.end(), operands.begin(), operands.end());
    return *this;
  }
  Builder& add(spv::Op op, uint32_t id, const std::string& text) {
    std::vector<uint32_t> operands(1 + text.size() / 4 + 1, 0);
    operands[0] = id;
    for (size_t i = 0; i < text.size(); ++i) operands[1 + i / 4] |= uint32_t(text[i]) << 8 * (i % 4);
    return add(op, operands);
  }
  Builder& built_in(GLSLstd450 code) {
    return add(spv::OpExtInst, {float_type, result, built_ins, uint32_t(code), x});
  }
  Module module() const { return Module(words_); }

 private:
  std::vector<uint32_t> words_;
};

std::string only_finding(const Builder& builder) {
  const std::vector<std::string> findings = find_unportable(builder.module());
  EXPECT_EQ(findings.size(), 1u);
  return findings.empty() ? std::string() : findings.front();
}

std::unordered_set<uint32_t> decorated_ids(const Module& module) {
  std::unordered_set<uint32_t> ids;
  module.for_each([&](const Instruction& instruction) {
    if (instruction.op == spv::OpDecorate && instruction.words[2] == spv::DecorationNoContraction) {
      EXPECT_TRUE(ids.insert(instruction.words[1]).second) << "decorated twice";
    }
  });
  return ids;
}

TEST(SpirvRules, RejectBuiltInsWhoseBitsDiffer) {
  for (const GLSLstd450 code :
       {GLSLstd450Fma,        GLSLstd450FMix,        GLSLstd450Normalize,    GLSLstd450Length,
        GLSLstd450Distance,   GLSLstd450Sin,         GLSLstd450Exp2,         GLSLstd450Log2,
        GLSLstd450Pow,        GLSLstd450InverseSqrt, GLSLstd450FMin,         GLSLstd450FMax,
        GLSLstd450FClamp,     GLSLstd450NMin,        GLSLstd450NMax,         GLSLstd450NClamp,
        GLSLstd450SmoothStep, GLSLstd450Reflect,     GLSLstd450PackHalf2x16, GLSLstd450Ldexp,
        GLSLstd450Fract,      GLSLstd450FSign,       GLSLstd450Cross,        GLSLstd450InterpolateAtOffset}) {
    EXPECT_EQ(find_unportable(Builder().built_in(code).module()).size(), 1u) << code;
  }
  EXPECT_NE(only_finding(Builder().built_in(GLSLstd450Normalize)).find("Normalize in shade"),
            std::string::npos);
}

TEST(SpirvRules, AllowBuiltInsThatAreExact) {
  for (const GLSLstd450 code :
       {GLSLstd450Sqrt, GLSLstd450Floor, GLSLstd450Ceil, GLSLstd450Trunc, GLSLstd450FAbs, GLSLstd450RoundEven,
        GLSLstd450UMin, GLSLstd450UMax, GLSLstd450SMin, GLSLstd450SMax, GLSLstd450UClamp, GLSLstd450FindILsb,
        GLSLstd450FindUMsb}) {
    EXPECT_TRUE(find_unportable(Builder().built_in(code).module()).empty()) << code;
  }
}

TEST(SpirvRules, IgnoreOtherExtendedInstructions) {
  Builder builder;
  builder.add(spv::OpExtInstImport, 50, "NonSemantic.Shader.DebugInfo.100");
  builder.add(spv::OpExtInst, {float_type, result, 50, GLSLstd450Normalize, x});
  EXPECT_TRUE(find_unportable(builder.module()).empty());
}

TEST(SpirvRules, RejectMatrixProductsReductionsAndSampling) {
  for (const spv::Op op : {spv::OpMatrixTimesVector, spv::OpVectorTimesMatrix, spv::OpMatrixTimesMatrix,
                           spv::OpFRem, spv::OpImageSampleExplicitLod, spv::OpImageGather,
                           spv::OpGroupNonUniformFAdd, spv::OpAtomicFAddEXT}) {
    EXPECT_EQ(find_unportable(Builder().add(op, {vector_type, result, x, y}).module()).size(), 1u) << op;
  }
  for (const spv::Op op :
       {spv::OpImageRead, spv::OpImageFetch, spv::OpGroupNonUniformIAdd, spv::OpAtomicIAdd}) {
    EXPECT_TRUE(find_unportable(Builder().add(op, {vector_type, result, x, y}).module()).empty()) << op;
  }
}

TEST(SpirvRules, RejectArithmeticWithAConstantZero) {
  for (const spv::Op op : {spv::OpFAdd, spv::OpFSub, spv::OpFMul, spv::OpFDiv, spv::OpDot}) {
    EXPECT_EQ(find_unportable(Builder().add(op, {float_type, result, x, zero}).module()).size(), 1u) << op;
    EXPECT_EQ(find_unportable(Builder().add(op, {float_type, result, zero_vector, x}).module()).size(), 1u)
        << op;
    EXPECT_TRUE(find_unportable(Builder().add(op, {float_type, result, x, two}).module()).empty()) << op;
  }
  EXPECT_TRUE(
      find_unportable(Builder().add(spv::OpFOrdLessThan, {float_type, result, x, zero}).module()).empty());
}

TEST(SpirvRules, TellTheLineOfTheSource) {
  Builder builder;
  builder.add(spv::OpString, 60, "trace.comp");
  builder.add(spv::OpLine, {60, 17, 3});
  builder.built_in(GLSLstd450FMax);
  EXPECT_NE(only_finding(builder).find("at trace.comp:17"), std::string::npos);
}

TEST(SpirvRules, ForbidContractionOfEveryFloatOperation) {
  uint32_t id = result;
  Builder builder;
  for (const spv::Op op : {spv::OpFAdd, spv::OpFSub, spv::OpFMul, spv::OpFDiv, spv::OpFMod,
                           spv::OpVectorTimesScalar, spv::OpDot, spv::OpOuterProduct}) {
    builder.add(op, {float_type, id++, x, y});
  }
  builder.add(spv::OpFNegate, {float_type, id++, x});
  builder.add(spv::OpIAdd, {float_type, id, x, y});
  const std::unordered_set<uint32_t> ids = decorated_ids(Module(forbid_contraction(builder.module())));
  EXPECT_EQ(ids.size(), id - result);
  EXPECT_FALSE(ids.contains(id));
}

TEST(SpirvRules, DecorateOnceAndBeforeTypes) {
  Builder builder;
  builder.add(spv::OpFAdd, {float_type, result, x, y});
  const Module once(forbid_contraction(builder.module()));
  const Module twice(forbid_contraction(once));
  EXPECT_EQ(once.words().size(), twice.words().size());
  bool types_begun = false;
  twice.for_each([&](const Instruction& instruction) {
    types_begun |= instruction.op == spv::OpTypeFloat;
    EXPECT_FALSE(types_begun && instruction.op == spv::OpDecorate);
  });
  EXPECT_TRUE(types_begun);
}

TEST(SpirvRules, RefuseWhatIsNoModule) {
  EXPECT_THROW(Module({}), std::runtime_error);
  EXPECT_THROW(Module({1, 2, 3, 4, 5}), std::runtime_error);
  EXPECT_THROW(Module({spv::MagicNumber, 0x00010500u, 0, 100, 0, 0xffff0000u | spv::OpFAdd}),
               std::runtime_error);
  EXPECT_THROW(Module({spv::MagicNumber, 0x00010500u, 0, 100, 0, 0}), std::runtime_error);
}

TEST(Kernels, AreFoundByNameInBothVariants) {
  EXPECT_FALSE(kernels::find_kernel("conformance/arithmetic").empty());
  EXPECT_FALSE(kernels::find_kernel("conformance/arithmetic_texel").empty());
  EXPECT_TRUE(kernels::find_kernel("conformance/arithmetic_").empty());
  EXPECT_TRUE(kernels::find_kernel("").empty());
  for (const auto set : {kernels::all_kernels(), test_kernels::all_kernels()}) {
    for (const kernels::Kernel& kernel : set) {
      EXPECT_EQ(kernels::find_kernel(set, kernel.name).data(), kernel.words.data()) << kernel.name;
    }
  }
}

TEST(Kernels, KeepTheRulesAsTheyShip) {
  ASSERT_FALSE(kernels::all_kernels().empty());
  for (const kernels::Kernel& kernel : kernels::all_kernels()) {
    const Module module({kernel.words.begin(), kernel.words.end()});
    EXPECT_TRUE(find_unportable(module).empty()) << kernel.name;
    EXPECT_EQ(forbid_contraction(module).size(), kernel.words.size()) << kernel.name << " may be contracted";
  }
}

}  // namespace
}  // namespace lodestone::spirv
