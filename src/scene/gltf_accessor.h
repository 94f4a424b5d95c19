// SPDX-License-Identifier: MIT
// Typed arrays out of the buffers of a glTF file, every length, offset and number checked.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <string>
#include <vector>

namespace lodestone::scene {

// One element of a sparse array.
template <class T>
struct Entry {
  uint32_t index = 0;
  T value{};
};

// All functions throw Error(bad_input) naming the file and `use` (what the accessor is for) where the
// accessor does not exist, does not fit its view and buffer, is misaligned, holds a NaN or an infinity, or
// has another type than asked for. Integers become floats as glTF 2.0, 3.6.2.2 and 3.11 say; an accessor
// without a view is all zeros but for its sparse elements.
//
// What is read may be larger than the file (views are shared; zeros have no bytes), but not without bound:
// together at most 64 MiB and 64 times the bytes of all buffers.
class AccessorReader {
 public:
  // The elements of `viewless` accessors are zeros whatever their view.
  AccessorReader(const tinygltf::Model& model, std::string file, std::set<uint32_t> viewless = {});

  const tinygltf::Model& model() const { return model_; }
  const std::string& file() const { return file_; }

  // The number of elements: for comparing lengths before anything is read.
  size_t count(int accessor, const std::string& use) const;

  std::vector<float> scalars(int accessor, const std::string& use) const;
  std::vector<glm::vec2> vec2s(int accessor, const std::string& use) const;
  std::vector<glm::vec3> vec3s(int accessor, const std::string& use) const;
  std::vector<glm::vec4> vec4s(int accessor, const std::string& use) const;
  std::vector<glm::vec4> colors(int accessor, const std::string& use) const;  // VEC3 with alpha 1, or VEC4
  std::vector<glm::mat4> mat4s(int accessor, const std::string& use) const;
  std::vector<uint32_t> indices(int accessor, const std::string& use) const;   // unsigned scalars
  std::vector<glm::uvec4> joints(int accessor, const std::string& use) const;  // unsigned VEC4
  // The elements that are not all zero, ascending by index. Costs nothing where the accessor has no view.
  std::vector<Entry<glm::vec3>> nonzero_vec3s(int accessor, const std::string& use) const;

  // Counts memory that a caller is about to fill from what it read against the bound above.
  void charge(uint64_t count, uint64_t bytes_each, const std::string& use) const;

 private:
  struct Layout;
  Layout layout(int accessor, const std::string& use) const;
  const std::byte* view_bytes(int view, size_t byte_offset, uint64_t count, size_t element_bytes,
                              size_t alignment, size_t* stride, const std::string& use) const;
  std::vector<uint32_t> sparse_indices(const Layout& from, const std::string& use) const;
  template <class Component>
  std::vector<Component> components(const Layout& from, const std::string& use) const;
  template <class Vector>
  std::vector<Vector> float_vectors(int accessor, int type, const char* wanted, const std::string& use) const;

  const tinygltf::Model& model_;
  std::string file_;
  std::set<uint32_t> viewless_;
  uint64_t allowance_ = 0;
  mutable uint64_t charged_ = 0;
};

}  // namespace lodestone::scene
