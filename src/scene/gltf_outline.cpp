// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_outline.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <unordered_map>

#include "lodestone/base/error.h"
#include "lodestone/scene/gltf_uri.h"
#include "lodestone/scene/scene.h"

namespace lodestone::scene {
namespace {

constexpr size_t max_depth = 128;
constexpr std::string_view material_extensions = "KHR_materials_";
// What nlohmann and tinygltf together make of the JSON, and what of it one value takes: an element of an
// array, a property of an object, either of them in `extras` or `extensions`.
constexpr uint64_t max_bytes = uint64_t(1) << 30;
constexpr uint64_t element_bytes = 32, property_bytes = 112, free_bytes = 168;
// tinygltf hands every sampler of an animation a copy of the animation's extensions.
constexpr uint64_t max_copied_values = uint64_t(1) << 20;

enum class Type {
  index,    // 0 to 2^31 - 1
  size,     // 0 to 2^53
  number,   // any number
  boolean,  // true or false
  text,
  array,             // of anything
  indices,           // array of indices
  numbers,           // array of numbers
  object,            // of anything, or of indices (attributes)
  index_or_object,   // `indices` of a primitive, of a sparse accessor
  number_or_numbers  // `scale` of a normal map, of a node
};

// What must hold for properties of these names wherever they stand outside `extras` and `extensions`. Names
// that glTF uses for things of different type (scale, target, indices, camera) are left to the code that
// reads them.
const std::unordered_map<std::string_view, Type>& property_types() {
  static const std::unordered_map<std::string_view, Type> types = {
      {"buffer", Type::index},
      {"bufferView", Type::index},
      {"byteLength", Type::size},
      {"byteOffset", Type::size},
      {"byteStride", Type::index},
      {"camera", Type::index},
      {"componentType", Type::index},
      {"count", Type::size},
      {"index", Type::index},
      {"input", Type::index},
      {"inverseBindMatrices", Type::index},
      {"magFilter", Type::index},
      {"material", Type::index},
      {"mesh", Type::index},
      {"minFilter", Type::index},
      {"mode", Type::index},
      {"node", Type::index},
      {"output", Type::index},
      {"sampler", Type::index},
      {"scene", Type::index},
      {"skeleton", Type::index},
      {"skin", Type::index},
      {"source", Type::index},
      {"texCoord", Type::index},
      {"wrapS", Type::index},
      {"wrapT", Type::index},
      {"alphaCutoff", Type::number},
      {"aspectRatio", Type::number},
      {"metallicFactor", Type::number},
      {"roughnessFactor", Type::number},
      {"strength", Type::number},
      {"xmag", Type::number},
      {"yfov", Type::number},
      {"ymag", Type::number},
      {"zfar", Type::number},
      {"znear", Type::number},
      {"doubleSided", Type::boolean},
      {"normalized", Type::boolean},
      {"alphaMode", Type::text},
      {"interpolation", Type::text},
      {"path", Type::text},
      {"uri", Type::text},
      {"accessors", Type::array},
      {"animations", Type::array},
      {"bufferViews", Type::array},
      {"buffers", Type::array},
      {"cameras", Type::array},
      {"channels", Type::array},
      {"extensionsRequired", Type::array},
      {"extensionsUsed", Type::array},
      {"images", Type::array},
      {"materials", Type::array},
      {"meshes", Type::array},
      {"nodes", Type::array},
      {"primitives", Type::array},
      {"samplers", Type::array},
      {"scenes", Type::array},
      {"skins", Type::array},
      {"targets", Type::array},
      {"textures", Type::array},
      {"children", Type::indices},
      {"joints", Type::indices},
      {"baseColorFactor", Type::numbers},
      {"emissiveFactor", Type::numbers},
      {"matrix", Type::numbers},
      {"rotation", Type::numbers},
      {"translation", Type::numbers},
      {"weights", Type::numbers},
      {"asset", Type::object},
      {"attributes", Type::object},
      {"baseColorTexture", Type::object},
      {"emissiveTexture", Type::object},
      {"metallicRoughnessTexture", Type::object},
      {"normalTexture", Type::object},
      {"occlusionTexture", Type::object},
      {"orthographic", Type::object},
      {"pbrMetallicRoughness", Type::object},
      {"perspective", Type::object},
      {"sparse", Type::object},
      {"indices", Type::index_or_object},
      {"target", Type::index_or_object},
      {"scale", Type::number_or_numbers},
  };
  return types;
}

// What an object takes beyond its properties: those of which a file may have very many, by the array they are
// in.
uint64_t object_bytes(std::string_view array) {
  static const std::unordered_map<std::string_view, uint64_t> sizes = {
      {"accessors", sizeof(tinygltf::Accessor)},
      {"animations", sizeof(tinygltf::Animation)},
      {"bufferViews", sizeof(tinygltf::BufferView)},
      {"buffers", sizeof(tinygltf::Buffer)},
      {"cameras", sizeof(tinygltf::Camera)},
      {"channels", sizeof(tinygltf::AnimationChannel)},
      {"images", sizeof(tinygltf::Image)},
      {"lights", sizeof(tinygltf::Light)},
      {"materials", sizeof(tinygltf::Material) + sizeof(Material)},
      {"meshes", sizeof(tinygltf::Mesh) + sizeof(Mesh)},
      {"nodes", sizeof(tinygltf::Node) + sizeof(Node)},
      {"primitives", sizeof(tinygltf::Primitive)},
      {"samplers", sizeof(tinygltf::Sampler)},
      {"scenes", sizeof(tinygltf::Scene)},
      {"skins", sizeof(tinygltf::Skin)},
      {"textures", sizeof(tinygltf::Texture)},
  };
  const auto found = sizes.find(array);
  return found == sizes.end() ? 0 : found->second;
}

// The events of nlohmann's parser, which does not recurse.
class OutlineReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  OutlineReader(const GltfContainer& gltf, GltfOutline& outline) : gltf_(gltf), outline_(outline) {}

  bool null() override { return scalar(Scalar{.kind = Scalar::Kind::other}); }
  bool boolean(bool) override { return scalar(Scalar{.kind = Scalar::Kind::boolean}); }
  bool number_integer(number_integer_t v) override {
    return scalar(Scalar{.kind = Scalar::Kind::integer, .negative = v < 0, .value = v < 0 ? 0 : uint64_t(v)});
  }
  bool number_unsigned(number_unsigned_t v) override {
    return scalar(Scalar{.kind = Scalar::Kind::integer, .value = v});
  }
  bool number_float(number_float_t, const string_t&) override {
    return scalar(Scalar{.kind = Scalar::Kind::real});
  }
  bool string(string_t& v) override { return scalar(Scalar{.kind = Scalar::Kind::text, .text = v}); }
  bool binary(binary_t&) override { return scalar(Scalar{.kind = Scalar::Kind::other}); }
  bool key(string_t& name) override {
    key_ = std::move(name);
    return true;
  }
  bool start_object(size_t) override { return open(false); }
  bool start_array(size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::string_view what = error.what();
    const size_t bracket = what.find("] ");
    fail_input(gltf_.file, "is not JSON that can be read, at byte {} ({}); export it again", position,
               what.substr(bracket == what.npos ? 0 : bracket + 2, 160));
  }

 private:
  struct Scalar {
    enum class Kind { integer, real, text, boolean, other } kind;
    bool negative = false;
    uint64_t value = 0;
    std::string_view text = {};
    bool is_index() const { return kind == Kind::integer && !negative && value <= max_index; }
    bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
    static constexpr uint64_t max_index = std::numeric_limits<int32_t>::max();
  };
  struct Frame {
    std::string name;  // of the property that holds it; empty in an array
    bool is_array;
    bool is_free;  // in `extras` or `extensions`: of no type that is known here
    uint64_t elements = 0;
  };
  struct Buffer {
    bool has_uri = false;
    uint64_t bytes = 0;
  };

  [[noreturn]] void fail_type(const char* wanted) const {
    fail_input(gltf_.file, "{} must be {}; export it again", place(), wanted);
  }

  // "meshes[3].primitives[0].mode"
  std::string place() const {
    std::string text;
    for (size_t i = 1; i < frames_.size(); ++i) {
      if (!frames_[i].name.empty()) text += (text.empty() ? "" : ".") + frames_[i].name;
      if (frames_[i].is_array)
        text += fmt::format("[{}]", frames_[i].elements == 0 ? 0 : frames_[i].elements - 1);
    }
    if (!frames_.empty() && !frames_.back().is_array) text += (text.empty() ? "" : ".") + key_;
    return text;
  }

  bool in_array(size_t depth, std::string_view name) const {
    return frames_.size() > depth && frames_[depth].is_array && frames_[depth].name == name;
  }

  // `bytes` is what the value takes beyond its place.
  void count_value(uint64_t bytes) {
    if (!frames_.empty()) {
      bytes += frames_.back().is_array ? element_bytes : property_bytes + key_.size();
      if (frames_.back().is_free) bytes += free_bytes;
      ++frames_.back().elements;
    }
    bytes_ += bytes;
    if (bytes_ > max_bytes) {
      fail_input(gltf_.file, "holds JSON that takes more than {} MiB, at {}; split the scene",
                 max_bytes >> 20, place().substr(0, 160));
    }
    if (in_array(1, "animations") && frames_.size() > 3 && frames_[3].name == "extensions") {
      copied_ += 1 + bytes / 512;
    }
  }

  bool scalar(const Scalar& v) {
    if (frames_.empty()) fail_input(gltf_.file, "is not a JSON object; is it a glTF file?");
    count_value(v.text.size());
    const Frame& holder = frames_.back();
    if (holder.is_free) {
      check_extension(holder, v);
      return true;
    }
    if (holder.is_array) {
      check_element(holder, v);
    } else {
      check_property(holder, v);
      note_property(v);
    }
    return true;
  }

  bool names_material_extension(const Frame& holder) const {
    return holder.is_free && holder.name == "extensions" && key_.starts_with(material_extensions);
  }

  // Of the extensions that are read, what tinygltf would take for absent.
  void check_extension(const Frame& holder, const Scalar& v) const {
    const bool index = (holder.name == "KHR_lights_punctual" && key_ == "light") ||
                       (holder.name == "KHR_texture_transform" && key_ == "texCoord");
    const bool of_texture = frames_.size() > 2 && holder.name.ends_with("Texture") &&
                            frames_[frames_.size() - 2].name.starts_with(material_extensions) &&
                            (key_ == "index" || key_ == "texCoord");
    const bool of_instances = holder.name == "attributes" && frames_.size() > 2 &&
                              frames_[frames_.size() - 2].name == "EXT_mesh_gpu_instancing";
    if ((index || of_texture || of_instances) && !v.is_index()) fail_type("an index");
    if (names_material_extension(holder)) fail_type("an object");
    const bool null = v.kind == Scalar::Kind::other;
    if (null && holder.name.starts_with(material_extensions)) fail_type("a value, not null");
    const bool of_light = frames_.size() > 4 && frames_[2].name == "KHR_lights_punctual";
    if (!of_light || v.is_number()) return;
    const bool number = holder.is_array ? holder.name == "color"
                                        : key_ == "intensity" || key_ == "range" ||
                                              key_ == "innerConeAngle" || key_ == "outerConeAngle";
    if (number) fail_type("a number");
  }

  void check_element(const Frame& array, const Scalar& v) {
    if (array.name.starts_with("extensions") && frames_.size() == 2) {
      if (v.kind != Scalar::Kind::text) fail_type("a string");
      (array.name == "extensionsUsed" ? outline_.extensions_used : outline_.extensions_required)
          .emplace_back(v.text);
    }
    const bool scene_nodes = array.name == "nodes" && frames_.size() > 3 && in_array(1, "scenes");
    const auto found = property_types().find(array.name);
    if (found == property_types().end()) return;
    if ((found->second == Type::indices || scene_nodes) && !v.is_index()) fail_type("an index");
    const bool numbers = found->second == Type::numbers || found->second == Type::number_or_numbers;
    if (numbers && !v.is_number()) fail_type("a number");
    if (found->second == Type::array && !scene_nodes && !array.name.starts_with("extensions"))
      fail_type("an object");
  }

  // Whether an object is `attributes` or a morph target: attribute names to accessors.
  bool maps_attributes(const Frame& object) const {
    return object.name == "attributes" || (frames_.size() > 1 && in_array(frames_.size() - 2, "targets"));
  }

  void check_property(const Frame& object, const Scalar& v) {
    if (maps_attributes(object)) {
      if (!v.is_index()) fail_type("the index of an accessor");
      return;
    }
    const auto found = property_types().find(key_);
    if (found == property_types().end()) return;
    switch (found->second) {
      case Type::index:
      case Type::index_or_object:
        if (!v.is_index()) fail_type("an integer from 0 to 2147483647");
        break;
      case Type::size: {
        // tinygltf keeps what stands in `sparse` in 32 bits.
        const bool sparse =
            std::any_of(frames_.begin(), frames_.end(), [](const Frame& f) { return f.name == "sparse"; });
        const uint64_t limit = sparse ? Scalar::max_index : uint64_t(1) << 53;
        if (v.kind != Scalar::Kind::integer || v.negative || v.value > limit)
          fail_type("an integer of 0 or more");
        break;
      }
      case Type::number:
      case Type::number_or_numbers:
        if (!v.is_number()) fail_type("a number");
        break;
      case Type::boolean:
        if (v.kind != Scalar::Kind::boolean) fail_type("true or false");
        break;
      case Type::text:
        if (v.kind != Scalar::Kind::text) fail_type("a string");
        break;
      case Type::array:
      case Type::indices:
      case Type::numbers:
        fail_type("an array");
      case Type::object:
        fail_type("an object");
    }
  }

  // Notes what is needed of buffers, images, accessors and primitives.
  void note_property(const Scalar& v) {
    const bool indices = key_ == "indices" && frames_.size() == 5 && in_array(3, "primitives");
    if (indices) index_accessors_.push_back(uint32_t(v.value));
    if (frames_.size() != 3) return;
    const bool of_buffer = in_array(1, "buffers");
    if (of_buffer && key_ == "byteLength") buffer_.bytes = v.value;
    if (of_buffer && key_ == "uri") buffer_.has_uri = !v.text.empty();
    if (key_ == "uri" && (of_buffer || in_array(1, "images"))) outline_.names_resources = true;
    if (key_ == "bufferView" && in_array(1, "accessors")) has_view_ = true;
  }

  bool open(bool is_array) {
    bool is_free = false;
    if (frames_.empty()) {
      if (is_array) fail_input(gltf_.file, "is not a JSON object; is it a glTF file?");
    } else {
      count_value(frames_.back().is_array ? object_bytes(frames_.back().name) : 0);
      const bool named = !frames_.back().is_array;
      is_free = frames_.back().is_free || (named && (key_ == "extras" || key_ == "extensions"));
      if (!is_free) check_container(is_array, named);
      if (is_array && named && names_material_extension(frames_.back())) fail_type("an object");
    }
    if (frames_.size() >= max_depth) {
      fail_input(gltf_.file, "nests JSON values more than {} deep at {}; export it again", max_depth,
                 place().substr(0, 160));
    }
    frames_.push_back({frames_.empty() || frames_.back().is_array ? std::string() : key_, is_array, is_free});
    return true;
  }

  void check_container(bool is_array, bool named) {
    const Frame& holder = frames_.back();
    const auto found = property_types().find(named ? std::string_view(key_) : std::string_view(holder.name));
    const bool known = found != property_types().end();
    if (!named) {
      if (known && found->second != Type::array) fail_type("an index or a number");
      if (known && is_array) fail_type("an object");
      if (in_array(1, "animations") && frames_.size() == 4 && holder.name == "samplers") ++samplers_;
      return;
    }
    if (maps_attributes(holder)) fail_type("the index of an accessor");
    if (!known) return;
    switch (found->second) {
      case Type::array:
      case Type::indices:
      case Type::numbers:
      case Type::number_or_numbers:
        if (!is_array) fail_type("an array");
        break;
      case Type::object:
      case Type::index_or_object:
        if (is_array) fail_type("an object");
        break;
      default:
        fail_type("a single value");
    }
  }

  bool close() {
    if (frames_.size() == 3 && in_array(1, "buffers")) close_buffer();
    if (frames_.size() == 3 && in_array(1, "accessors")) {
      if (!has_view_) viewless_accessors_.push_back(uint32_t(frames_[1].elements - 1));
      has_view_ = false;
    }
    if (frames_.size() == 3 && in_array(1, "animations")) {
      if (copied_ * samplers_ > max_copied_values) {
        fail_input(gltf_.file, "animations[{}] has too large extensions for its {} samplers; remove them",
                   frames_[1].elements - 1, samplers_);
      }
      copied_ = samplers_ = 0;
    }
    frames_.pop_back();
    if (frames_.empty()) find_viewless_indices();
    return true;
  }

  void find_viewless_indices() {
    std::sort(index_accessors_.begin(), index_accessors_.end());
    for (const uint32_t accessor : viewless_accessors_) {
      if (std::binary_search(index_accessors_.begin(), index_accessors_.end(), accessor)) {
        outline_.viewless_indices.push_back(accessor);
      }
    }
  }

  void close_buffer() {
    const uint64_t index = frames_[1].elements - 1;
    if (!buffer_.has_uri && (!gltf_.is_binary || index > 0)) {
      fail_input(gltf_.file, "buffers[{}] has no uri, which only the first buffer of a GLB may leave out",
                 index);
    }
    if (!buffer_.has_uri && gltf_.binary_chunk.size() < buffer_.bytes) {
      fail_input(gltf_.file,
                 "buffers[{}] has {} bytes by its byteLength, but the binary chunk {}; export it again",
                 index, buffer_.bytes, gltf_.binary_chunk.size());
    }
    if (buffer_.bytes == 0) fail_input(gltf_.file, "buffers[{}] has no bytes; export it again", index);
    buffer_ = {};
  }

  const GltfContainer& gltf_;
  GltfOutline& outline_;
  std::vector<Frame> frames_;
  std::string key_;
  uint64_t bytes_ = 0;
  uint64_t copied_ = 0, samplers_ = 0;  // of the animation being read
  Buffer buffer_;                       // the buffer being read
  bool has_view_ = false;               // the accessor being read
  std::vector<uint32_t> viewless_accessors_, index_accessors_;
};

}  // namespace

GltfOutline outline_gltf(const GltfContainer& gltf) {
  GltfOutline outline;
  OutlineReader reader(gltf, outline);
  nlohmann::json::sax_parse(gltf.json.begin(), gltf.json.end(), &reader);
  return outline;
}

}  // namespace lodestone::scene
