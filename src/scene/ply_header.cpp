// SPDX-License-Identifier: MIT
#include "lodestone/scene/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "lodestone/scene/scene.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene::ply {
namespace {

struct TypeName {
  std::string_view name, sized_name;
  Type type;
  uint32_t size;
  double full_scale;
};

constexpr std::array<TypeName, 8> type_names{{
    {"char", "int8", Type::int8, 1, 127},
    {"uchar", "uint8", Type::uint8, 1, 255},
    {"short", "int16", Type::int16, 2, 32767},
    {"ushort", "uint16", Type::uint16, 2, 65535},
    {"int", "int32", Type::int32, 4, 2147483647},
    {"uint", "uint32", Type::uint32, 4, 4294967295},
    {"float", "float32", Type::float32, 4, 1},
    {"double", "float64", Type::float64, 8, 1},
}};

const TypeName& names_of(Type type) {
  return type_names[static_cast<size_t>(type)];
}

// The characters that end a line of this header. Binary data follow the last of them at once, so whether a \n
// behind a \r belongs to the line must be known: the first line tells.
std::string_view find_line_end(const std::string& file, std::string_view bytes) {
  if (bytes.empty()) fail_input(file, "is empty; expected a PLY file");
  if (bytes.substr(0, 4) == "ply\n") return "\n";
  if (bytes.substr(0, 5) == "ply\r\n") return "\r\n";
  if (bytes.substr(0, 4) == "ply\r") return "\r";
  fail_input(file,
             "line 1: is not a PLY file, which begins with a line `ply`; check the file or its extension");
}

// One line of the header after another.
class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view bytes)
      : file_(file), bytes_(bytes), line_end_(find_line_end(file, bytes)), line_reader_(file, "") {}

  Header parse() {
    next_line();
    for (;;) {
      next_line();
      const std::string_view keyword = line_reader_.word();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        parse_format();
      } else if (keyword == "element") {
        parse_element();
      } else if (keyword == "property") {
        parse_property();
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        line_reader_.fail("`{}` is no keyword of a PLY header; export the file again", printable(keyword));
      }
    }
    if (!has_format_)
      line_reader_.fail("the header declares no format; add a line `format ascii 1.0` or a binary one");
    header_.body = position_;
    header_.body_line = line_ + 1;
    return std::move(header_);
  }

 private:
  void next_line() {
    if (position_ >= bytes_.size()) {
      fail_input(file_, "line {}: the file ends inside its header, before `end_header`; get the whole file",
                 line_);
    }
    const size_t end = std::min(bytes_.find(line_end_, position_), bytes_.size());
    line_reader_ = TextReader(file_, bytes_.substr(position_, end - position_), ++line_);
    position_ = std::min(end + line_end_.size(), bytes_.size());
  }

  void parse_format() {
    const std::string_view name = line_reader_.word(), version = line_reader_.word();
    if (name == "ascii") {
      header_.format = Format::ascii;
    } else if (name == "binary_little_endian") {
      header_.format = Format::binary_little_endian;
    } else if (name == "binary_big_endian") {
      header_.format = Format::binary_big_endian;
    } else {
      line_reader_.fail(
          "unknown format `{}`; known are ascii, binary_little_endian and binary_big_endian, export as one "
          "of them",
          printable(name));
    }
    if (version != "1.0") line_reader_.fail("unknown version `{}`; only 1.0 is known", printable(version));
    if (has_format_) line_reader_.fail("the format is declared twice; export the file again");
    has_format_ = true;
  }

  void parse_element() {
    Element element;
    element.name = line_reader_.word();
    if (element.name.empty()) line_reader_.fail("an element has no name; export the file again");
    const int64_t count = line_reader_.to_integer(line_reader_.word(), "the count of an element");
    if (count < 0) line_reader_.fail("element {} has the negative count {}", printable(element.name), count);
    element.count = static_cast<uint64_t>(count);
    if (header_.find(element.name) != nullptr) {
      line_reader_.fail("element {} is declared twice; export the file again", printable(element.name));
    }
    if (header_.elements.size() == max_elements) {
      line_reader_.fail("the header declares more than {} elements; export the file again", max_elements);
    }
    header_.elements.push_back(std::move(element));
  }

  Type parse_type() {
    const std::string_view word = line_reader_.word();
    for (const TypeName& names : type_names) {
      if (word == names.name || word == names.sized_name) return names.type;
    }
    line_reader_.fail("unknown type `{}`; known are char uchar short ushort int uint float double",
                      printable(word));
  }

  void parse_property() {
    if (header_.elements.empty()) line_reader_.fail("a property stands before the first element");
    Property property;
    TextReader ahead = line_reader_;
    if (ahead.word() == "list") {
      line_reader_ = ahead;
      property.is_list = true;
      property.count_type = parse_type();
    }
    property.type = parse_type();
    property.name = line_reader_.word();
    if (property.name.empty()) line_reader_.fail("a property has no name; export the file again");
    header_.elements.back().properties.push_back(std::move(property));
  }

  // Far above what any writer declares; keeps the search for doubles of a hostile header short.
  static constexpr size_t max_elements = 1000;

  const std::string& file_;
  std::string_view bytes_, line_end_;
  size_t position_ = 0;
  uint64_t line_ = 0;
  TextReader line_reader_;
  Header header_;
  bool has_format_ = false;
};

// The least room that a record can take. In ASCII a value takes a character and a separator.
uint64_t least_record_size(const Element& element, Format format) {
  uint64_t size = 0;
  for (const Property& property : element.properties) {
    size += format == Format::ascii ? 2 : size_of(property.is_list ? property.count_type : property.type);
  }
  return size;
}

void check_counts(const std::string& file, const Header& header, uint64_t body_size) {
  // The very last separator may be missing.
  uint64_t left = body_size + (header.format == Format::ascii ? 1 : 0);
  for (const Element& element : header.elements) {
    const uint64_t size = least_record_size(element, header.format);
    if (size == 0) continue;
    if (element.count > left / size) {
      fail_input(file,
                 "element {} declares {} records of at least {} bytes, but only {} bytes follow the header; "
                 "the file "
                 "is cut off or its header wrong, get the whole file",
                 printable(element.name), element.count, size, body_size);
    }
    left -= element.count * size;
  }
}

}  // namespace

uint32_t size_of(Type type) {
  return names_of(type).size;
}
double full_scale(Type type) {
  return names_of(type).full_scale;
}

uint32_t Element::find(std::string_view property) const {
  for (uint32_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return i;
  }
  return none;
}

const Element* Header::find(std::string_view element) const {
  for (const Element& candidate : elements) {
    if (candidate.name == element) return &candidate;
  }
  return nullptr;
}

Header parse_header(const std::string& file, std::string_view bytes) {
  Header header = HeaderParser(file, bytes).parse();
  check_counts(file, header, bytes.size() - header.body);
  return header;
}

}  // namespace lodestone::scene::ply
