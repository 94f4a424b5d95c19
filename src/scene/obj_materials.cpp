// SPDX-License-Identifier: MIT
// MTL as Wavefront described it, with the Pr, Pm, Pc and Pcr of the physically based extension (Exocortex,
// 2015).
#include "lodestone/scene/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/decode_image.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

// One material of a few lines does not fill more.
constexpr uint64_t max_library_bytes = uint64_t(1) << 28;

// The roughness whose microfacet distribution is as wide as a Blinn-Phong lobe of this exponent:
// alpha^2 = 2 / (exponent + 2) (Walter et al. 2007, "Microfacet Models for Refraction through Rough
// Surfaces"), with alpha = roughness^2.
float roughness_of_exponent(float exponent) {
  return std::sqrt(std::sqrt(2.0f / (std::max(exponent, 0.0f) + 2.0f)));
}

constexpr size_t max_warnings = 10;

// Number of values behind an option of a texture statement: as few as `least`, as many as `most`.
struct MapOption {
  std::string_view name;
  int least, most;
};

constexpr MapOption map_options[] = {
    {"-s", 1, 3},       {"-o", 1, 3},     {"-t", 1, 3},    {"-mm", 2, 2},         {"-blendu", 1, 1},
    {"-blendv", 1, 1},  {"-boost", 1, 1}, {"-cc", 1, 1},   {"-clamp", 1, 1},      {"-texres", 1, 1},
    {"-imfchan", 1, 1}, {"-bm", 1, 1},    {"-type", 1, 1}, {"-colorspace", 1, 1},
};

bool is_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
}

}  // namespace

class MtlParser {
 public:
  MtlParser(ObjMaterials& into, const std::string& file, std::string_view text)
      : into_(into), reader_(file, text) {}

  void parse() {
    do {
      const std::string_view keyword = reader_.word();
      if (keyword == "newmtl") {
        begin_material();
      } else if (material_ != nullptr) {
        parse_property(keyword);
      }
    } while (reader_.next_line());
    end_material();
  }

 private:
  // What its statements say together about light that enters it.
  struct Transparency {
    float opacity = 1;
    uint64_t line = 0;  // of the first statement by which it is less than 1; 0: of none
    float illum = 2;
    float ior = 0;  // 0: not said
    glm::vec3 filter{1};
  };

  void begin_material() {
    end_material();
    const std::string name(reader_.rest_of_line());
    const auto [entry, is_new] =
        into_.materials_by_name_.emplace(name, static_cast<uint32_t>(into_.materials_.size()));
    if (is_new) {
      into_.materials_.emplace_back();
    } else {
      into_.warn(fmt::format("{}: line {}: material {} is there already; the first one counts",
                             reader_.file(), reader_.line(), printable(name)));
      ignored_ = {};
    }
    material_ = is_new ? &into_.materials_.back() : &ignored_;
    material_->name = name;
    material_->metallic = 0;
    has_roughness_ = false;
  }

  // Only some illumination models let light through, 6 and 7 refract it. What is `d` to the others is a
  // cut-out or nothing: they stay opaque.
  void end_material() {
    const Transparency seen = std::exchange(transparency_, {});
    if (material_ == nullptr) return;
    const bool refracts = seen.illum == 6 || seen.illum == 7;
    const bool lets_through = refracts || seen.illum == 4 || seen.illum == 9;
    // A model that refracts says by itself that it is clear; exporters name the others for all they write.
    const float transmission = seen.line != 0 ? 1 - seen.opacity : refracts ? 1.0f : 0.0f;
    if (lets_through && transmission > 0) {
      material_->transmission = transmission;
      material_->thickness = refracts ? 1.0f : 0.0f;
      // One colour tints both the light that passes and the light that is scattered.
      const glm::vec3 color =
          glm::mix(glm::vec3(material_->base_color), glm::clamp(seen.filter, 0.0f, 1.0f), transmission);
      material_->base_color = glm::vec4(color, 1);
    } else if (seen.line != 0) {
      into_.warn_once("d", fmt::format("{}: line {}: material {} is transparent, but drawn opaque",
                                       reader_.file(), seen.line, printable(material_->name)));
    }
    // Many exporters write 1, of which no light is reflected, where they know no better.
    const bool says_ior = seen.ior > 1 || (seen.ior > 0 && material_->transmission > 0);
    if (says_ior) material_->ior = std::max(seen.ior, 1.0f);
  }

  void parse_property(std::string_view keyword) {
    if (keyword == "Kd") {
      material_->base_color = glm::vec4(glm::clamp(parse_color("Kd"), 0.0f, 1.0f), 1.0f);
    } else if (keyword == "Ke") {
      material_->emissive = glm::max(parse_color("Ke"), glm::vec3(0));
    } else if (keyword == "Ns") {
      const float exponent = reader_.read_float("Ns");
      if (!has_roughness_) material_->roughness = roughness_of_exponent(exponent);
    } else if (keyword == "Pr") {
      material_->roughness = std::clamp(reader_.read_float("Pr"), 0.0f, 1.0f);
      has_roughness_ = true;
    } else if (keyword == "Pc") {
      material_->clearcoat = std::clamp(reader_.read_float("Pc"), 0.0f, 1.0f);
    } else if (keyword == "Pcr") {
      material_->clearcoat_roughness = std::clamp(reader_.read_float("Pcr"), 0.0f, 1.0f);
    } else if (keyword == "Ni") {
      transparency_.ior = reader_.read_float("Ni");
    } else if (keyword == "Tf") {
      transparency_.filter = parse_color("Tf");
    } else if (keyword == "illum") {
      transparency_.illum = reader_.read_float("illum");
    } else if (keyword == "Pm") {
      material_->metallic = std::clamp(reader_.read_float("Pm"), 0.0f, 1.0f);
    } else if (keyword == "map_Kd") {
      parse_map(material_->base_color_texture);
    } else if (keyword == "map_Ke") {
      parse_map(material_->emissive_texture);
    } else if (keyword == "d" || keyword == "Tr") {
      parse_opacity(keyword);
    } else if (keyword.starts_with("map_") || keyword == "norm" || equal_ignoring_case(keyword, "bump") ||
               keyword == "disp" || keyword == "decal") {
      into_.warn_once(keyword, fmt::format("{}: line {}: {} is not used", reader_.file(), reader_.line(),
                                           printable(keyword)));
    }
  }

  // `d opacity`, `d -halo opacity` or `Tr transparency`.
  void parse_opacity(std::string_view keyword) {
    std::string_view word = reader_.word();
    if (word == "-halo") word = reader_.word();
    const float value = reader_.to_float(word, keyword == "d" ? "d" : "Tr");
    transparency_.opacity = std::clamp(keyword == "d" ? value : 1 - value, 0.0f, 1.0f);
    if (transparency_.opacity < 1 && transparency_.line == 0) transparency_.line = reader_.line();
  }

  // `r g b`, or `r` alone for grey.
  glm::vec3 parse_color(const char* what) {
    const std::string_view first = reader_.word();
    if (first == "spectral" || first == "xyz") {
      into_.warn(fmt::format("{}: line {}: {} is given as {} and taken as white; give it as r g b",
                             reader_.file(), reader_.line(), what, first));
      return glm::vec3(1);
    }
    glm::vec3 color(reader_.to_float(first, what));
    const std::string_view second = reader_.word();
    if (!second.empty()) {
      color.g = reader_.to_float(second, what);
      color.b = reader_.read_float(what);
    }
    return color;
  }

  // `[-option values...] file name to the end of the line`.
  void parse_map(Texture& texture) {
    glm::vec2 scale(1), offset(0);
    for (;;) {
      TextReader ahead = reader_;
      const std::string_view word = ahead.word();
      const auto option = std::find_if(std::begin(map_options), std::end(map_options),
                                       [&](const MapOption& candidate) { return candidate.name == word; });
      if (option == std::end(map_options)) break;
      reader_ = ahead;
      parse_option(*option, texture, scale, offset);
    }
    texture.image = into_.image(std::string(reader_.rest_of_line()));
    // OBJ counts v from the bottom: v_obj = 1 - v, and the scaled and shifted v_obj is turned back likewise.
    texture.u_row = {scale.x, 0, offset.x};
    texture.v_row = {0, scale.y, 1 - scale.y - offset.y};
    if (!std::isfinite(texture.v_row.z)) reader_.fail("the options -s and -o are out of range; correct them");
  }

  void parse_option(const MapOption& option, Texture& texture, glm::vec2& scale, glm::vec2& offset) {
    for (int i = 0; i < option.most; ++i) {
      TextReader ahead = reader_;
      const std::string_view value = ahead.word();
      if (i >= option.least && !is_number(value)) break;
      reader_ = ahead;
      if (option.name == "-clamp") texture.wrap_u = texture.wrap_v = wrap_of_clamp(value);
      if (option.name == "-s" && i < 2) scale[i] = reader_.to_float(value, "-s");
      if (option.name == "-o" && i < 2) offset[i] = reader_.to_float(value, "-o");
    }
  }

  static Texture::Wrap wrap_of_clamp(std::string_view value) {
    return value == "on" ? Texture::Wrap::clamp : Texture::Wrap::repeat;
  }

  ObjMaterials& into_;
  TextReader reader_;
  Material* material_ = nullptr;  // the one being described
  Material ignored_;
  bool has_roughness_ = false;  // Pr says more than Ns
  Transparency transparency_;
};

ObjMaterials::ObjMaterials(const std::filesystem::path& obj_file)
    : obj_file_(obj_file.string()), folder_(obj_file) {}

void ObjMaterials::read_library(const std::string& name) {
  if (!libraries_.insert(name).second) return;
  std::filesystem::path path;
  try {
    path = folder_.find(name);
  } catch (const Error& error) {
    warn(fmt::format("{}; its materials are left out", error.what()));
    misses_library_ = true;
    return;
  }
  const std::vector<std::byte> contents = read_file(path, max_library_bytes);
  MtlParser(*this, path.string(), as_text(contents)).parse();
}

uint32_t ObjMaterials::find(std::string_view name) {
  const auto found = materials_by_name_.find(name);
  if (found != materials_by_name_.end()) return found->second;
  // One message about a missing library says enough.
  if (!misses_library_ && warnings_ <= max_warnings && unknown_.emplace(name).second) {
    warn(fmt::format("{}: no material library has the material {}; its faces are left without", obj_file_,
                     printable(name)));
  }
  return none;
}

uint32_t ObjMaterials::image(const std::string& name) {
  std::filesystem::path path;
  try {
    path = folder_.find(name);
  } catch (const Error& error) {
    warn(fmt::format("{}; the texture is left out", error.what()));
    return none;
  }
  const auto [entry, is_new] = images_by_path_.emplace(path, none);
  if (is_new) {
    Image decoded = decode_image_file(path);
    decoded.name = name;
    entry->second = static_cast<uint32_t>(images_.size());
    images_.push_back(std::move(decoded));
  }
  return entry->second;
}

void ObjMaterials::warn(const std::string& message) {
  if (warnings_ > max_warnings) return;
  const bool last = warnings_++ == max_warnings;
  log::warn(last ? obj_file_ + ": further warnings about its materials are left out" : message);
}

void ObjMaterials::warn_once(std::string_view keyword, const std::string& message) {
  if (keywords_.size() <= max_warnings && keywords_.emplace(keyword).second) warn(message);
}

void ObjMaterials::move_to(Scene& scene) {
  scene.materials = std::move(materials_);
  scene.images = std::move(images_);
}

}  // namespace lodestone::scene
