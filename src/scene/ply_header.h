// SPDX-License-Identifier: MIT
// What the header of a PLY file declares. Format: Turk 1994, "The PLY Polygon File Format".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::scene::ply {

enum class Format { ascii, binary_little_endian, binary_big_endian };

enum class Type : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// In bytes, in a binary file.
uint32_t size_of(Type type);
// The largest value of an integer type; 1 for the floating-point ones: the value that means full colour.
double full_scale(Type type);

struct Property {
  std::string name;
  Type type = Type::float32;  // of the value, or of each item of a list
  bool is_list = false;
  Type count_type = Type::uint8;  // of the number of items before a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;

  // The property's index, or `none`.
  uint32_t find(std::string_view property) const;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;  // in the order in which their data follow
  uint64_t body = 0;              // byte at which the data begin
  uint64_t body_line = 0;         // and their line, counted from 1

  const Element* find(std::string_view element) const;
};

// Throws Error(bad_input), naming `file` and the line, unless the header is complete and well formed and the
// bytes behind it are enough for the counts that it declares (lists counted as empty ones).
Header parse_header(const std::string& file, std::string_view bytes);

}  // namespace lodestone::scene::ply
