// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_container.h"

#include <cstdint>
#include <cstring>
#include <limits>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"

namespace lodestone::scene {
namespace {

// glTF 2.0, 4.4: magic, version and total length; then chunks of length, type and data. Little-endian
// throughout.
constexpr uint32_t magic_gltf = 0x46546c67, chunk_json = 0x4e4f534a, chunk_binary = 0x004e4942;
constexpr uint64_t header_bytes = 12, chunk_header_bytes = 8;

uint32_t word(const std::vector<std::byte>& bytes, uint64_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::span<const std::byte> chunk(const GltfContainer& gltf, uint64_t offset, uint64_t end, uint32_t type,
                                 const char* name) {
  if (offset + chunk_header_bytes > end) {
    fail_input(gltf.file, "is cut short: its {} chunk has no header; copy or export it again", name);
  }
  const uint64_t length = word(gltf.bytes, offset);
  if (word(gltf.bytes, offset + 4) != type) {
    fail_input(gltf.file, "has another chunk at byte {} where the {} chunk belongs; export it again", offset,
               name);
  }
  if (length > end - offset - chunk_header_bytes) {
    fail_input(gltf.file,
               "is cut short: its {} chunk of {} bytes ends after byte {}; copy or export it again", name,
               length, end);
  }
  return std::span(gltf.bytes).subspan(offset + chunk_header_bytes, length);
}

void read_chunks(GltfContainer& gltf) {
  if (gltf.bytes.size() < header_bytes) fail_input(gltf.file, "is cut short: a GLB has a header of 12 bytes");
  const uint32_t version = word(gltf.bytes, 4);
  if (version != 2) fail_input(gltf.file, "is a GLB of version {}; convert it to glTF 2.0", version);
  const uint64_t end = word(gltf.bytes, 8);
  if (end > gltf.bytes.size()) {
    fail_input(gltf.file, "is cut short: {} bytes of {}; copy or export it again", gltf.bytes.size(), end);
  }
  const std::span<const std::byte> json = chunk(gltf, header_bytes, end, chunk_json, "JSON");
  gltf.json = {reinterpret_cast<const char*>(json.data()), json.size()};
  const uint64_t next = header_bytes + chunk_header_bytes + json.size();
  if (next < end) gltf.binary_chunk = chunk(gltf, next, end, chunk_binary, "binary");
}

}  // namespace

GltfContainer open_gltf(const std::filesystem::path& path) {
  GltfContainer gltf;
  gltf.file = path.string();
  gltf.bytes = read_file(path, std::numeric_limits<uint32_t>::max());  // lengths in a GLB have 32 bits
  if (gltf.bytes.empty()) fail_input(gltf.file, "is empty; copy or export it again");
  gltf.is_binary = gltf.bytes.size() >= 4 && word(gltf.bytes, 0) == magic_gltf;
  if (gltf.is_binary) {
    read_chunks(gltf);
  } else {
    gltf.json = {reinterpret_cast<const char*>(gltf.bytes.data()), gltf.bytes.size()};
  }
  return gltf;
}

std::string rebuild_glb(const std::string& json, std::span<const std::byte> binary_chunk) {
  const size_t json_bytes = (json.size() + 3) / 4 * 4, binary_bytes = (binary_chunk.size() + 3) / 4 * 4;
  std::string glb;
  const auto append = [&](uint64_t number) {
    const auto stored = static_cast<uint32_t>(number);
    glb.append(reinterpret_cast<const char*>(&stored), sizeof stored);
  };
  const bool with_binary = !binary_chunk.empty();
  append(magic_gltf);
  append(2);
  append(header_bytes + chunk_header_bytes + json_bytes +
         (with_binary ? chunk_header_bytes + binary_bytes : 0));
  append(json_bytes);
  append(chunk_json);
  glb += json;
  glb.append(json_bytes - json.size(), ' ');
  if (!with_binary) return glb;
  append(binary_bytes);
  append(chunk_binary);
  glb.append(reinterpret_cast<const char*>(binary_chunk.data()), binary_chunk.size());
  glb.append(binary_bytes - binary_chunk.size(), '\0');
  return glb;
}

}  // namespace lodestone::scene
