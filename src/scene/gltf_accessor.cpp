// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lodestone/base/error.h"

namespace lodestone::scene {
namespace {

constexpr uint64_t base_allowance = uint64_t(1) << 26;
constexpr uint64_t allowance_per_byte = 64;

size_t component_bytes(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;  // signed 32-bit and double: tinygltf lets them pass, glTF does not have them
  }
}

bool is_unsigned_integer(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class Stored>
Stored load(const std::byte* from) {
  Stored value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// A signed -128 is -1 as -127 is: the scale is that of the largest value (glTF 2.0, 3.11).
template <class Stored>
float from_integer(Stored value, bool normalized) {
  if (!normalized) return float(value);
  const float scaled = float(value) / float(std::numeric_limits<Stored>::max());
  return std::is_signed_v<Stored> ? std::max(scaled, -1.0f) : scaled;
}

float load_float(const std::byte* from, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return from_integer(load<int8_t>(from), normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return from_integer(load<uint8_t>(from), normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return from_integer(load<int16_t>(from), normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return from_integer(load<uint16_t>(from), normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return from_integer(load<uint32_t>(from), normalized);
    default:
      return load<float>(from);
  }
}

uint32_t load_unsigned(const std::byte* from, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(from);
    default:
      return load<uint32_t>(from);
  }
}

}  // namespace

// An accessor with its views found and checked.
struct AccessorReader::Layout {
  const tinygltf::Accessor* accessor = nullptr;
  size_t components = 0;       // an element
  size_t component_bytes = 0;  // a component
  size_t count = 0;
  const std::byte* base = nullptr;  // null: all zeros
  size_t stride = 0;
  size_t sparse_count = 0;
  const std::byte* sparse_indices = nullptr;
  const std::byte* sparse_values = nullptr;
  size_t element_bytes() const { return components * component_bytes; }
};

AccessorReader::AccessorReader(const tinygltf::Model& model, std::string file, std::set<uint32_t> viewless)
    : model_(model), file_(std::move(file)), viewless_(std::move(viewless)) {
  uint64_t bytes = 0;
  for (const tinygltf::Buffer& buffer : model_.buffers) bytes += buffer.data.size();
  allowance_ = base_allowance + allowance_per_byte * bytes;
}

void AccessorReader::charge(uint64_t count, uint64_t bytes_each, const std::string& use) const {
  const uint64_t left = allowance_ - charged_;
  if (count > left / bytes_each) {
    fail_input(file_, "{}: {} elements are more than a file of this size can mean; export it again", use,
               count);
  }
  charged_ += count * bytes_each;
}

size_t AccessorReader::count(int accessor, const std::string& use) const {
  if (accessor < 0 || size_t(accessor) >= model_.accessors.size()) {
    fail_input(file_, "{}: accessor {} does not exist (there are {}); export it again", use, accessor,
               model_.accessors.size());
  }
  return model_.accessors[size_t(accessor)].count;
}

// Finds `count` elements of a view; the distance between them goes to *stride, or must be their size where
// null.
const std::byte* AccessorReader::view_bytes(int view, size_t byte_offset, uint64_t count,
                                            size_t element_bytes, size_t alignment, size_t* stride,
                                            const std::string& use) const {
  if (view < 0 || size_t(view) >= model_.bufferViews.size()) {
    fail_input(file_, "{}: buffer view {} does not exist; export it again", use, view);
  }
  const tinygltf::BufferView& v = model_.bufferViews[size_t(view)];
  if (v.buffer < 0 || size_t(v.buffer) >= model_.buffers.size()) {
    fail_input(file_, "{}: buffer {} does not exist; export it again", use, v.buffer);
  }
  const std::vector<unsigned char>& data = model_.buffers[size_t(v.buffer)].data;
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset) {
    fail_input(file_, "{}: buffer view {} lies outside its buffer of {} bytes; export it again", use, view,
               data.size());
  }
  const size_t step = v.byteStride == 0 ? element_bytes : v.byteStride;
  if (step < element_bytes || (stride == nullptr && step != element_bytes)) {
    fail_input(file_, "{}: buffer view {} has a stride of {} for elements of {} bytes; export it again", use,
               view, v.byteStride, element_bytes);
  }
  if (byte_offset % alignment != 0 || (v.byteOffset + byte_offset) % alignment != 0 ||
      step % alignment != 0) {
    fail_input(file_, "{}: buffer view {} is not aligned to {} bytes; export it again", use, view, alignment);
  }
  const bool fits = byte_offset <= v.byteLength && element_bytes <= v.byteLength - byte_offset &&
                    count - 1 <= (v.byteLength - byte_offset - element_bytes) / step;
  if (!fits) {
    fail_input(file_, "{}: {} elements do not fit buffer view {} of {} bytes; export it again", use, count,
               view, v.byteLength);
  }
  if (stride != nullptr) *stride = step;
  return reinterpret_cast<const std::byte*>(data.data()) + v.byteOffset + byte_offset;
}

AccessorReader::Layout AccessorReader::layout(int index, const std::string& use) const {
  Layout found;
  found.count = count(index, use);
  const tinygltf::Accessor& a = model_.accessors[size_t(index)];
  found.accessor = &a;
  found.components = size_t(std::max(tinygltf::GetNumComponentsInType(uint32_t(a.type)), 0));
  found.component_bytes = component_bytes(a.componentType);
  if (found.component_bytes == 0 || found.components == 0) {
    fail_input(file_, "{}: accessor {} has components of type {}, which glTF does not know; export it again",
               use, index, a.componentType);
  }
  if (found.count == 0) fail_input(file_, "{}: accessor {} is empty; export it again", use, index);
  if (a.bufferView >= 0 && !viewless_.contains(uint32_t(index))) {
    found.base = view_bytes(a.bufferView, a.byteOffset, found.count, found.element_bytes(),
                            found.component_bytes, &found.stride, use);
  }
  if (!a.sparse.isSparse) return found;
  const auto& sparse = a.sparse;
  if (sparse.count < 1 || size_t(sparse.count) > found.count) {
    fail_input(file_, "{}: {} sparse elements of {}; export it again", use, sparse.count, found.count);
  }
  if (!is_unsigned_integer(sparse.indices.componentType)) {
    fail_input(file_, "{}: sparse indices of type {}; export it again", use, sparse.indices.componentType);
  }
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    fail_input(file_, "{}: sparse elements at a negative offset; export it again", use);
  }
  const size_t index_bytes = component_bytes(sparse.indices.componentType);
  found.sparse_count = size_t(sparse.count);
  found.sparse_indices = view_bytes(sparse.indices.bufferView, size_t(sparse.indices.byteOffset),
                                    found.sparse_count, index_bytes, index_bytes, nullptr, use);
  found.sparse_values =
      view_bytes(sparse.values.bufferView, size_t(sparse.values.byteOffset), found.sparse_count,
                 found.element_bytes(), found.component_bytes, nullptr, use);
  return found;
}

std::vector<uint32_t> AccessorReader::sparse_indices(const Layout& from, const std::string& use) const {
  const int type = from.accessor->sparse.indices.componentType;
  const size_t bytes = lodestone::scene::component_bytes(type);
  std::vector<uint32_t> indices(from.sparse_count);
  for (size_t i = 0; i < indices.size(); ++i) {
    indices[i] = load_unsigned(from.sparse_indices + i * bytes, type);
    if (indices[i] >= from.count || (i > 0 && indices[i] <= indices[i - 1])) {
      fail_input(file_, "{}: sparse index {} at place {} is out of range or does not ascend; export it again",
                 use, indices[i], i);
    }
  }
  return indices;
}

// All components of all elements, base and sparse, as floats or unsigned integers.
template <class Component>
std::vector<Component> AccessorReader::components(const Layout& from, const std::string& use) const {
  charge(from.count, from.components * sizeof(Component), use);
  const int type = from.accessor->componentType;
  std::vector<Component> values(from.count * from.components);
  const auto load_element = [&](const std::byte* bytes, Component* to) {
    for (size_t c = 0; c < from.components; ++c, bytes += from.component_bytes) {
      if constexpr (std::is_same_v<Component, float>) {
        to[c] = load_float(bytes, type, from.accessor->normalized);
        if (!std::isfinite(to[c]))
          fail_input(file_, "{}: holds a number that is not finite; export it again", use);
      } else {
        to[c] = load_unsigned(bytes, type);
      }
    }
  };
  if (from.base != nullptr) {
    for (size_t i = 0; i < from.count; ++i)
      load_element(from.base + i * from.stride, &values[i * from.components]);
  }
  const std::vector<uint32_t> sparse = sparse_indices(from, use);
  for (size_t i = 0; i < sparse.size(); ++i) {
    load_element(from.sparse_values + i * from.element_bytes(), &values[sparse[i] * from.components]);
  }
  return values;
}

template <class Vector>
std::vector<Vector> AccessorReader::float_vectors(int accessor, int type, const char* wanted,
                                                  const std::string& use) const {
  const Layout from = layout(accessor, use);
  if (from.accessor->type != type) fail_input(file_, "{}: is not of type {}; export it again", use, wanted);
  const std::vector<float> values = components<float>(from, use);
  std::vector<Vector> vectors(from.count);
  static_assert(std::is_trivially_copyable_v<Vector>);
  std::memcpy(static_cast<void*>(vectors.data()), values.data(), values.size() * sizeof(float));
  return vectors;
}

std::vector<float> AccessorReader::scalars(int accessor, const std::string& use) const {
  return float_vectors<float>(accessor, TINYGLTF_TYPE_SCALAR, "SCALAR", use);
}

std::vector<glm::vec2> AccessorReader::vec2s(int accessor, const std::string& use) const {
  return float_vectors<glm::vec2>(accessor, TINYGLTF_TYPE_VEC2, "VEC2", use);
}

std::vector<glm::vec3> AccessorReader::vec3s(int accessor, const std::string& use) const {
  return float_vectors<glm::vec3>(accessor, TINYGLTF_TYPE_VEC3, "VEC3", use);
}

std::vector<glm::vec4> AccessorReader::vec4s(int accessor, const std::string& use) const {
  return float_vectors<glm::vec4>(accessor, TINYGLTF_TYPE_VEC4, "VEC4", use);
}

std::vector<glm::vec4> AccessorReader::colors(int accessor, const std::string& use) const {
  if (layout(accessor, use).components == 4) return vec4s(accessor, use);
  std::vector<glm::vec4> colors;
  for (const glm::vec3& c : vec3s(accessor, use)) colors.emplace_back(c, 1.0f);
  return colors;
}

std::vector<glm::mat4> AccessorReader::mat4s(int accessor, const std::string& use) const {
  return float_vectors<glm::mat4>(accessor, TINYGLTF_TYPE_MAT4, "MAT4", use);
}

std::vector<uint32_t> AccessorReader::indices(int accessor, const std::string& use) const {
  const Layout from = layout(accessor, use);
  if (from.accessor->type != TINYGLTF_TYPE_SCALAR || !is_unsigned_integer(from.accessor->componentType)) {
    fail_input(file_, "{}: are not unsigned scalars; export it again", use);
  }
  return components<uint32_t>(from, use);
}

std::vector<glm::uvec4> AccessorReader::joints(int accessor, const std::string& use) const {
  const Layout from = layout(accessor, use);
  if (from.accessor->type != TINYGLTF_TYPE_VEC4 || !is_unsigned_integer(from.accessor->componentType)) {
    fail_input(file_, "{}: are not unsigned VEC4; export it again", use);
  }
  const std::vector<uint32_t> values = components<uint32_t>(from, use);
  std::vector<glm::uvec4> vectors(from.count);
  std::memcpy(vectors.data(), values.data(), values.size() * sizeof(uint32_t));
  return vectors;
}

std::vector<Entry<glm::vec3>> AccessorReader::nonzero_vec3s(int accessor, const std::string& use) const {
  const Layout from = layout(accessor, use);
  if (from.accessor->type != TINYGLTF_TYPE_VEC3)
    fail_input(file_, "{}: is not of type VEC3; export it again", use);
  std::vector<Entry<glm::vec3>> entries;
  if (from.base != nullptr) {
    const std::vector<glm::vec3> values = vec3s(accessor, use);
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i] != glm::vec3(0)) entries.push_back({uint32_t(i), values[i]});
    }
    return entries;
  }
  charge(from.sparse_count, sizeof(Entry<glm::vec3>), use);
  for (const uint32_t index : sparse_indices(from, use)) {
    const std::byte* bytes = from.sparse_values + entries.size() * from.element_bytes();
    glm::vec3 value;
    for (int c = 0; c < 3; ++c) {
      value[c] = load_float(bytes + size_t(c) * from.component_bytes, from.accessor->componentType,
                            from.accessor->normalized);
      if (!std::isfinite(value[c]))
        fail_input(file_, "{}: holds a number that is not finite; export it again", use);
    }
    entries.push_back({index, value});
  }
  std::erase_if(entries, [](const Entry<glm::vec3>& entry) { return entry.value == glm::vec3(0); });
  return entries;
}

}  // namespace lodestone::scene
