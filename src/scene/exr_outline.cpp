// SPDX-License-Identifier: MIT
// Layout: "OpenEXR File Layout", Industrial Light & Magic. Magic number, version and flags, then attributes:
// name and type ended by zeros, size, value. An empty name ends them.
#include "lodestone/scene/exr_outline.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "lodestone/base/error.h"

namespace lodestone::scene {
namespace {

constexpr uint32_t deep_flag = 0x800, multi_part_flag = 0x1000;

struct TypeSize {
  std::string_view type;
  uint32_t size;
};

// The library reads values of these types without regard to the size that the file states.
constexpr std::array fixed_sizes{
    TypeSize{"box2i", 16},      TypeSize{"box2f", 16},   TypeSize{"chromaticities", 32},
    TypeSize{"compression", 1}, TypeSize{"double", 8},   TypeSize{"envmap", 1},
    TypeSize{"float", 4},       TypeSize{"int", 4},      TypeSize{"keycode", 28},
    TypeSize{"lineOrder", 1},   TypeSize{"m33f", 36},    TypeSize{"m33d", 72},
    TypeSize{"m44f", 64},       TypeSize{"m44d", 128},   TypeSize{"rational", 8},
    TypeSize{"tiledesc", 9},    TypeSize{"timecode", 8}, TypeSize{"v2i", 8},
    TypeSize{"v2f", 8},         TypeSize{"v2d", 16},     TypeSize{"v3i", 12},
    TypeSize{"v3f", 12},        TypeSize{"v3d", 24},     TypeSize{"deepImageState", 1},
};

class HeaderWalker {
 public:
  HeaderWalker(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  ExrOutline walk() {
    read_number();  // the magic number
    const uint32_t flags = read_number();
    if ((flags & (deep_flag | multi_part_flag)) != 0) {
      fail_input(file_,
                 "byte 4: is an OpenEXR file of several parts or of deep samples; save a single flat image");
    }
    for (std::string_view name = read_name(); !name.empty(); name = read_name()) read_attribute(name);
    return outline_;
  }

 private:
  uint32_t read_number() {
    if (bytes_.size() - position_ < 4) fail_truncated();
    uint32_t number = 0;
    for (int i = 3; i >= 0; --i) number = (number << 8) | static_cast<uint8_t>(bytes_[position_ + size_t(i)]);
    position_ += 4;
    return number;
  }

  std::string_view read_name() {
    const size_t start = position_, end = bytes_.find('\0', start);
    if (end == std::string_view::npos) fail_truncated();
    position_ = end + 1;
    return bytes_.substr(start, end - start);
  }

  // What follows the name: type, size, value.
  void read_attribute(std::string_view name) {
    const std::string_view type = read_name();
    const size_t place = position_;
    const uint32_t size = read_number();
    if (size > bytes_.size() - position_) {
      fail_input(file_, "byte {}: an attribute claims {} bytes, but {} are left; get the whole file", place,
                 size, bytes_.size() - position_);
    }
    const size_t start = position_;
    if (value_size(type, size) != size) {
      fail_input(file_,
                 "byte {}: an attribute claims {} bytes, which its type does not have; save the image again",
                 place, size);
    }
    if (name == "dataWindow" && type == "box2i") {
      position_ = start;
      read_data_window();
    }
    position_ = start + size;
  }

  // The first and the last column and row, as x, y, x, y.
  void read_data_window() {
    std::array<int64_t, 4> corners{};
    for (int64_t& corner : corners) corner = static_cast<int32_t>(read_number());
    outline_.width = corners[2] < corners[0] ? 0 : static_cast<uint64_t>(corners[2] - corners[0] + 1);
    outline_.height = corners[3] < corners[1] ? 0 : static_cast<uint64_t>(corners[3] - corners[1] + 1);
  }

  // The size that the value has by its type or its own contents.
  uint64_t value_size(std::string_view type, uint32_t size) {
    if (type == "chlist") {
      const size_t start = position_;
      constexpr uint32_t half = 1;
      outline_.texel_bytes = 0;
      while (!read_name().empty()) {
        outline_.texel_bytes += read_number() == half ? 2 : 4;
        for (int i = 0; i < 3; ++i) read_number();  // a flag and padding, the sampling in x and y
      }
      return position_ - start;
    }
    if (type == "preview") {
      const uint64_t width = read_number(), height = read_number();
      return width > size || height > size ? 0 : 8 + 4 * width * height;
    }
    for (const TypeSize& fixed : fixed_sizes) {
      if (fixed.type == type) return fixed.size;
    }
    return size;
  }

  [[noreturn]] void fail_truncated() const {
    fail_input(file_, "byte {}: the file ends inside its header; get the whole file", bytes_.size());
  }

  const std::string& file_;
  std::string_view bytes_;
  size_t position_ = 0;
  ExrOutline outline_;
};

}  // namespace

ExrOutline read_exr_outline(const std::string& file, std::string_view bytes) {
  return HeaderWalker(file, bytes).walk();
}

}  // namespace lodestone::scene
