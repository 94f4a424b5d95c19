// SPDX-License-Identifier: MIT
#include "lodestone/scene/gltf_prepare.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace lodestone::scene {
namespace {

using Json = nlohmann::json;

class Preparation {
 public:
  explicit Preparation(const GltfContainer& gltf) : document_(Json::parse(gltf.json)) {}

  PreparedGltf prepare(const GltfOutline& outline) {
    Json::array_t& buffers = array_of("buffers");
    for (size_t i = 0; i < buffers.size(); ++i) replace_uri(buffers[i], fmt::format("buffers[{}]", i), true);
    Json::array_t& images = array_of("images");
    for (size_t i = 0; i < images.size(); ++i) replace_uri(images[i], fmt::format("images[{}]", i), false);
    const bool has_views = !array_of("bufferViews").empty();
    Json::array_t& accessors = array_of("accessors");
    for (uint32_t index : outline.viewless_indices) {
      if (!has_views || index >= accessors.size() || accessors[index].contains("bufferView")) continue;
      accessors[index]["bufferView"] = 0;
      prepared_.viewless.insert(index);
    }
    prepared_.json = document_.dump();
    return std::move(prepared_);
  }

 private:
  // The array `name`, which the outline has found to be one of objects; empty where there is none.
  Json::array_t& array_of(const char* name) {
    const auto found = document_.find(name);
    return found == document_.end() ? nothing_ : found->get_ref<Json::array_t&>();
  }

  void replace_uri(Json& object, std::string place, bool is_buffer) {
    const auto uri = object.find("uri");
    if (uri == object.end() || uri->get_ref<const std::string&>().empty()) return;
    GltfResource resource{std::move(place), std::move(uri->get_ref<std::string&>()), {}};
    size_t number = prepared_.resources.size();
    if (is_buffer) {
      resource.bytes = object.value("byteLength", uint64_t(0));
    } else {
      number = images_.emplace(resource.uri, number).first->second;
    }
    if (number == prepared_.resources.size()) prepared_.resources.push_back(std::move(resource));
    *uri = fmt::format("#{}", number);
  }

  Json document_;
  Json::array_t nothing_;
  std::map<std::string, size_t> images_;  // by uri
  PreparedGltf prepared_;
};

}  // namespace

PreparedGltf prepare_gltf(const GltfContainer& gltf, const GltfOutline& outline) {
  if (!outline.names_resources && outline.viewless_indices.empty()) return {};
  return Preparation(gltf).prepare(outline);
}

const GltfResource* find_resource(const PreparedGltf& prepared, const std::string& uri) {
  size_t number = 0;
  const char* end = uri.data() + uri.size();
  if (uri.empty() || uri[0] != '#' || std::from_chars(uri.data() + 1, end, number).ptr != end) return nullptr;
  return number < prepared.resources.size() ? &prepared.resources[number] : nullptr;
}

}  // namespace lodestone::scene
