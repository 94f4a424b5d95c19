// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_parse.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/asset_folder.h"
#include "lodestone/scene/decode_image.h"

namespace lodestone::scene {
namespace {

// A file that is named again and again must not fill the memory.
constexpr uint64_t max_repeated_bytes = uint64_t(1) << 28;
// lengths of images pass through an int
constexpr uint64_t max_external_image_bytes = uint64_t(1) << 30;
constexpr uint64_t max_texels_in_all = uint64_t(1) << 30;  // 4 GiB as RGBA8

struct EncodedImage {
  std::string subject;  // of errors
  std::string name;
  std::vector<std::byte> own_bytes;
  std::span<const std::byte> bytes;  // of own_bytes, or of a buffer of the model
};

// What tinygltf's callbacks work on. They must not throw through tinygltf: the first error is kept for later.
struct ParseState {
  const GltfContainer& gltf;
  const GltfOutline& outline;
  tinygltf::Model& model;
  AssetFolder folder;
  size_t external_buffers_read = 0;
  std::set<std::filesystem::path> files_read = {};
  uint64_t repeated_bytes = 0;
  std::vector<EncodedImage> images = {};
  std::map<std::string, uint32_t> image_by_source = {};
  std::vector<uint32_t> image_of = {};
  std::exception_ptr error = {};

  template <class Function>
  bool guard(const Function& function) {
    try {
      function();
      return true;
    } catch (...) {
      if (!error) error = std::current_exception();
      return false;
    }
  }

  std::filesystem::path find(const std::string& name) const;
  std::vector<std::byte> read_external(const std::string& name);
  void note_image(const tinygltf::Image& image, size_t index, std::span<const std::byte> bytes);
  std::span<const std::byte> bytes_of_view(int view, const std::string& subject) const;
};

std::filesystem::path ParseState::find(const std::string& name) const {
  if (name.starts_with("data:")) {
    fail_input(gltf.file,
               "embeds data of a kind that is not read ({}...); embed them as application/octet-stream",
               name.substr(0, 32));
  }
  if (name.find("://") != std::string::npos) {
    fail_input(gltf.file, "names '{}' on the network; download it and put it beside the scene",
               name.substr(0, 120));
  }
  try {
    return folder.find(name);
  } catch (const Error&) {
    // tinygltf takes a plus sign for a space, as in queries; in a path it is itself.
    if (name.find(' ') == std::string::npos) throw;
    std::string with_plus = name;
    std::replace(with_plus.begin(), with_plus.end(), ' ', '+');
    try {
      return folder.find(with_plus);
    } catch (const Error&) {
    }
    throw;
  }
}

std::vector<std::byte> ParseState::read_external(const std::string& name) {
  const std::filesystem::path path = find(name);
  const bool is_buffer = external_buffers_read < outline.external_buffer_bytes.size();
  std::vector<std::byte> bytes = is_buffer ? read_file(path) : read_file(path, max_external_image_bytes);
  if (!files_read.insert(path).second) repeated_bytes += bytes.size();
  if (repeated_bytes > max_repeated_bytes) {
    fail_input(gltf.file, "names '{}' again and again; let all buffer views share one buffer",
               name.substr(0, 120));
  }
  if (!is_buffer) return bytes;
  // A buffer's file may be longer than the buffer, but not shorter (glTF 2.0, 3.6.1).
  const uint64_t declared = outline.external_buffer_bytes[external_buffers_read++];
  if (bytes.size() < declared) {
    fail_input(path.string(),
               "is cut short: {} bytes, but {} by the byteLength in {}; copy or export it again",
               bytes.size(), declared, gltf.file);
  }
  bytes.resize(declared);
  return bytes;
}

std::span<const std::byte> ParseState::bytes_of_view(int view, const std::string& subject) const {
  const tinygltf::BufferView& v = model.bufferViews.at(size_t(view));
  const tinygltf::Buffer& buffer = model.buffers.at(size_t(v.buffer));
  const std::span<const std::byte> all = std::as_bytes(std::span(buffer.data));
  if (v.byteOffset > all.size() || v.byteLength > all.size() - v.byteOffset) {
    fail_input(subject, "lies outside buffer {} of {} bytes; export the scene again", v.buffer, all.size());
  }
  return all.subspan(v.byteOffset, v.byteLength);
}

void ParseState::note_image(const tinygltf::Image& image, size_t index, std::span<const std::byte> bytes) {
  const bool in_view = image.bufferView >= 0;
  const std::string source = in_view             ? fmt::format("view {}", image.bufferView)
                             : image.uri.empty() ? std::string()
                                                 : "file " + image.uri;
  image_of.resize(std::max(image_of.size(), index + 1), none);
  if (const auto known = image_by_source.find(source); known != image_by_source.end()) {
    image_of[index] = known->second;
    return;
  }
  EncodedImage encoded;
  encoded.name = image.name.empty() ? image.uri : image.name;
  encoded.subject = fmt::format("{}: image {} '{}'", gltf.file, index, encoded.name.substr(0, 120));
  if (in_view) {
    encoded.bytes = bytes_of_view(image.bufferView, encoded.subject);
  } else {
    encoded.own_bytes.assign(bytes.begin(), bytes.end());
    encoded.bytes = encoded.own_bytes;
  }
  image_of[index] = uint32_t(images.size());
  if (!source.empty()) image_by_source[source] = image_of[index];
  images.push_back(std::move(encoded));
}

bool file_exists(const std::string& name, void* user) {
  ParseState& state = *static_cast<ParseState*>(user);
  return state.guard([&] { state.find(name); });
}

std::string keep_path(const std::string& name, void*) {
  return name;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
  ParseState& state = *static_cast<ParseState*>(user);
  return state.guard([&] {
    const std::vector<std::byte> bytes = state.read_external(name);
    const unsigned char* first = reinterpret_cast<const unsigned char*>(bytes.data());
    out->assign(first, first + bytes.size());
  });
}

bool load_image(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void* user) {
  ParseState& state = *static_cast<ParseState*>(user);
  return state.guard([&] {
    const std::span<const unsigned char> encoded(bytes, size_t(std::max(size, 0)));
    state.note_image(*image, size_t(index), std::as_bytes(encoded));
  });
}

// tinygltf reports as an error, and yet succeeds: a skin without inverseBindMatrices, which is right, and a
// channel without a node, which an extension may allow and which is skipped. Anything else it drops from the
// model.
std::string first_serious(const std::string& errors) {
  constexpr std::string_view harmless[] = {"'inverseBindMatrices' property is missing",
                                           "'node' property is missing",
                                           "`node` field is missing in animation.channels.target"};
  size_t begin = 0;
  while (begin < errors.size()) {
    const size_t end = std::min(errors.find('\n', begin), errors.size());
    const std::string line = errors.substr(begin, std::min<size_t>(end - begin, 200));
    begin = end + 1;
    const bool skip =
        line.empty() || std::any_of(std::begin(harmless), std::end(harmless),
                                    [&](std::string_view text) { return line.starts_with(text); });
    if (!skip) return line;
  }
  return {};
}

void run_tinygltf(ParseState& state) {
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({file_exists, keep_path, read_whole_file, nullptr, &state});
  parser.SetImageLoader(load_image, &state);
  const GltfContainer& gltf = state.gltf;
  std::string errors, warnings;
  bool parsed = false;
  try {
    // With no folder of its own every file name reaches the callbacks as it stands.
    if (gltf.is_binary) {
      parsed = parser.LoadBinaryFromMemory(&state.model, &errors, &warnings,
                                           reinterpret_cast<const unsigned char*>(gltf.bytes.data()),
                                           unsigned(gltf.bytes.size()), "");
    } else {
      parsed = parser.LoadASCIIFromString(&state.model, &errors, &warnings, gltf.json.data(),
                                          unsigned(gltf.json.size()), "");
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    errors = error.what();
    parsed = false;
  }
  if (state.error) std::rethrow_exception(state.error);
  const std::string serious = first_serious(errors);
  if (!parsed || !serious.empty()) {
    fail_input(gltf.file, "is not valid glTF ({}); check it with a glTF validator and export it again",
               serious.empty() ? "a required property is missing" : serious);
  }
}

// Decodes in parallel; of several broken images the first is reported.
std::vector<Image> decode_all(const std::string& file, const std::vector<EncodedImage>& encoded) {
  std::vector<Image> images(encoded.size());
  std::vector<std::exception_ptr> errors(encoded.size());
  std::atomic<uint64_t> texels{0};
  parallel_for(encoded.size(), 1, [&](uint64_t i, uint64_t) {
    try {
      if (texels.load() > max_texels_in_all) return;
      images[i] = decode_image(encoded[i].bytes, encoded[i].subject);
      images[i].name = encoded[i].name;
      texels += uint64_t(images[i].width) * images[i].height;
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  if (texels.load() > max_texels_in_all) {
    fail_input(file, "has images of more than {} texels in all; reduce them", max_texels_in_all);
  }
  return images;
}

}  // namespace

ParsedGltf parse_gltf(const GltfContainer& gltf, const GltfOutline& outline) {
  ParsedGltf parsed;
  ParseState state{.gltf = gltf, .outline = outline, .model = parsed.model, .folder = AssetFolder(gltf.file)};
  run_tinygltf(state);
  if (!parsed.model.asset.version.starts_with("2.")) {
    fail_input(gltf.file, "is glTF of version '{}'; convert it to 2.0",
               parsed.model.asset.version.substr(0, 16));
  }
  parsed.images = decode_all(gltf.file, state.images);
  parsed.image_of = std::move(state.image_of);
  parsed.image_of.resize(parsed.model.images.size(), none);
  for (size_t i = 0; i < parsed.image_of.size(); ++i) {
    if (parsed.image_of[i] == none)
      fail_input(gltf.file, "image {} holds no bytes; export the scene again", i);
  }
  return parsed;
}

}  // namespace lodestone::scene
