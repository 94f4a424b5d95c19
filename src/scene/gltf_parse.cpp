// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_parse.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/base/parallel.h"
#include "lodestone/scene/asset_folder.h"
#include "lodestone/scene/decode_image.h"
#include "lodestone/scene/gltf_prepare.h"
#include "lodestone/scene/gltf_uri.h"
#include "lodestone/scene/text_reader.h"

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
  const PreparedGltf& prepared;
  tinygltf::Model& model;
  AssetFolder folder;
  std::set<std::filesystem::path> files_read = {};
  uint64_t repeated_bytes = 0;
  std::vector<EncodedImage> images = {};
  std::map<std::string, uint32_t> image_by_source = {};
  std::vector<uint32_t> image_of = {};
  std::exception_ptr error = {};

  template <class Function>
  bool guard(const Function& function) {
    if (error) return false;  // tinygltf tries all images, whatever became of the first
    try {
      function();
      return true;
    } catch (...) {
      if (!error) error = std::current_exception();
      return false;
    }
  }

  const GltfResource& resource(const std::string& name) const;
  std::filesystem::path find(const GltfResource& resource) const;
  std::vector<std::byte> read(const GltfResource& resource);
  void note_image(const tinygltf::Image& image, size_t index, std::span<const std::byte> bytes);
  std::span<const std::byte> bytes_of_view(int view, const std::string& subject) const;
};

// The resource that tinygltf asks for by the name that it has in the prepared JSON.
const GltfResource& ParseState::resource(const std::string& name) const {
  const GltfResource* found = find_resource(prepared, name);
  if (found == nullptr) fail_input(gltf.file, "names '{}', which cannot be opened", shown(name, 120));
  return *found;
}

std::filesystem::path ParseState::find(const GltfResource& resource) const {
  if (resource.uri.find("://") != std::string::npos) {
    fail_input(gltf.file, "{} is at '{}', which is not read; put the file beside the scene and name it alone",
               resource.place, printable(resource.uri));
  }
  return folder.find(percent_decoded(resource.uri));
}

std::vector<std::byte> ParseState::read(const GltfResource& resource) {
  std::string source = gltf.file;
  std::vector<std::byte> bytes;
  if (is_data_uri(resource.uri)) {
    std::optional<std::vector<std::byte>> decoded = decode_data_uri(resource.uri);
    if (!decoded) fail_input(gltf.file, "{}: its data URI is malformed; export it again", resource.place);
    bytes = std::move(*decoded);
  } else {
    const std::filesystem::path path = find(resource);
    source = path.string();
    bytes = resource.bytes ? read_file(path) : read_file(path, max_external_image_bytes);
    if (!files_read.insert(path).second) repeated_bytes += bytes.size();
    if (repeated_bytes > max_repeated_bytes) {
      fail_input(gltf.file, "names '{}' again and again; let all buffer views share one buffer",
                 printable(resource.uri));
    }
  }
  if (bytes.empty()) fail_input(source, "{} is empty; copy or export it again", resource.place);
  if (!resource.bytes) return bytes;
  // A buffer's bytes may be more than it declares, but not fewer (3.6.1).
  if (bytes.size() < *resource.bytes) {
    fail_input(source,
               "is cut short: {} bytes, but {} by the byteLength of {} in {}; copy or export it again",
               bytes.size(), *resource.bytes, resource.place, gltf.file);
  }
  bytes.resize(*resource.bytes);
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
  const std::string source = in_view ? fmt::format("view {}", image.bufferView) : image.uri;
  image_of.resize(std::max(image_of.size(), index + 1), none);
  if (const auto known = image_by_source.find(source); known != image_by_source.end()) {
    image_of[index] = known->second;
    return;
  }
  EncodedImage encoded;
  encoded.name = image.name;
  if (image.name.empty() && !in_view && !is_data_uri(resource(image.uri).uri)) {
    encoded.name = resource(image.uri).uri;
  }
  encoded.subject = fmt::format("{}: image {} '{}'", gltf.file, index, shown(encoded.name, 120));
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
  return state.guard([&] {
    const GltfResource& resource = state.resource(name);
    if (!is_data_uri(resource.uri)) state.find(resource);
  });
}

std::string keep_path(const std::string& name, void*) {
  return name;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
  ParseState& state = *static_cast<ParseState*>(user);
  return state.guard([&] {
    const std::vector<std::byte> bytes = state.read(state.resource(name));
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
  const std::string& json = state.prepared.json;
  const std::string binary = gltf.is_binary && !json.empty() ? rebuild_glb(json, gltf.binary_chunk) : "";
  std::string errors, warnings;
  bool parsed = false;
  try {
    // With no folder of its own every file name reaches the callbacks as it stands.
    if (gltf.is_binary) {
      const std::string_view whole = binary.empty() ? as_text(gltf.bytes) : binary;
      parsed = parser.LoadBinaryFromMemory(&state.model, &errors, &warnings,
                                           reinterpret_cast<const unsigned char*>(whole.data()),
                                           unsigned(whole.size()), "");
    } else {
      const std::string_view whole = json.empty() ? gltf.json : json;
      parsed = parser.LoadASCIIFromString(&state.model, &errors, &warnings, whole.data(),
                                          unsigned(whole.size()), "");
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
               serious.empty() ? "a required property is missing" : shown(serious, 200));
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
  PreparedGltf prepared = prepare_gltf(gltf, outline);
  ParseState state{
      .gltf = gltf, .prepared = prepared, .model = parsed.model, .folder = AssetFolder(gltf.file)};
  run_tinygltf(state);
  if (!parsed.model.asset.version.starts_with("2.")) {
    fail_input(gltf.file, "is glTF of version '{}'; convert it to 2.0",
               printable(parsed.model.asset.version));
  }
  const std::string& least = parsed.model.asset.minVersion;
  if (!least.empty() && least != "2.0") {
    fail_input(gltf.file, "needs a reader of glTF {}; export it as 2.0", printable(least));
  }
  parsed.images = decode_all(gltf.file, state.images);
  parsed.image_of = std::move(state.image_of);
  parsed.viewless = std::move(prepared.viewless);
  parsed.image_of.resize(parsed.model.images.size(), none);
  for (size_t i = 0; i < parsed.image_of.size(); ++i) {
    if (parsed.image_of[i] == none)
      fail_input(gltf.file, "image {} holds no bytes; export the scene again", i);
  }
  return parsed;
}

}  // namespace lodestone::scene
