// SPDX-License-Identifier: MIT
// Layout: "OpenEXR File Layout", Industrial Light & Magic. Magic number, version and flags, then attributes:
// name and type ended by zeros, size, value. An empty name ends them.
#include "lodestone/scene/exr_header.h"

#include <cstdint>

#include "lodestone/base/error.h"

namespace lodestone::scene {
namespace {

constexpr uint32_t deep_flag = 0x800, multi_part_flag = 0x1000;

class HeaderWalker {
 public:
  HeaderWalker(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  void walk() {
    read_number();  // the magic number
    const uint32_t flags = read_number();
    if ((flags & (deep_flag | multi_part_flag)) != 0) {
      fail_input(file_,
                 "byte 4: is an OpenEXR file of several parts or of deep samples; save a single flat image");
    }
    while (read_name() > 0) {
      read_name();  // the type
      const size_t place = position_;
      const uint32_t size = read_number();
      if (size > bytes_.size() - position_) {
        fail_input(file_, "byte {}: an attribute claims {} bytes, but {} are left; get the whole file", place,
                   size, bytes_.size() - position_);
      }
      position_ += size;
    }
  }

 private:
  uint32_t read_number() {
    if (bytes_.size() - position_ < 4) fail_truncated();
    uint32_t number = 0;
    for (int i = 3; i >= 0; --i) number = (number << 8) | static_cast<uint8_t>(bytes_[position_ + size_t(i)]);
    position_ += 4;
    return number;
  }

  // Passes over a name; its length.
  size_t read_name() {
    const size_t end = bytes_.find('\0', position_);
    if (end == std::string_view::npos) fail_truncated();
    const size_t length = end - position_;
    position_ = end + 1;
    return length;
  }

  [[noreturn]] void fail_truncated() const {
    fail_input(file_, "byte {}: the file ends inside its header; get the whole file", bytes_.size());
  }

  const std::string& file_;
  std::string_view bytes_;
  size_t position_ = 0;
};

}  // namespace

void check_exr_header(const std::string& file, std::string_view bytes) {
  HeaderWalker(file, bytes).walk();
}

}  // namespace lodestone::scene
