// SPDX-License-Identifier: MIT
// What every loader has to do with any bytes whatever: give a valid scene, or throw Error(bad_input).
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/environment.h"
#include "lodestone/scene/load.h"

namespace lodestone::fuzz {

// The loader of a format: a folder of the corpus.
inline scene::Scene load_as(const std::string& format, const std::filesystem::path& path) {
  if (format == "gltf" || format == "glb") return scene::load_gltf(path);
  if (format == "obj") return scene::load_obj(path);
  if (format == "ply") return scene::load_ply(path);
  if (format == "stl") return scene::load_stl(path);
  if (format == "height_map") return scene::load_height_map(path, {});
  if (format == "environment") {
    scene::Scene scene;
    scene.environment = scene::load_environment(path);
    return scene;
  }
  throw std::logic_error("no loader for the format " + format);
}

// The name under which the bytes are loaded. Loaders choose by content what they can, so one name a format
// will do. An OBJ file that names fuzz.obj as its material library is read as one too.
inline std::string file_name(const std::string& format) {
  return format == "height_map" ? "fuzz.png" : format == "environment" ? "fuzz.hdr" : "fuzz." + format;
}

// True where the bytes are a valid scene, false where they are refused as bad input: by the loader, or for
// glTF by `validate`, which checks what such a file states about cameras and lights. Throws for any fault:
// another exit code, an exception that is no Error, a mesh that `validate` refuses.
inline bool load_bytes(const std::string& format, std::span<const std::byte> bytes,
                       const std::filesystem::path& folder) {
  log::set_level(log::Level::quiet);
  const std::filesystem::path path = folder / file_name(format);
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + path.string());
  scene::Scene loaded;
  try {
    loaded = load_as(format, path);
  } catch (const Error& error) {
    if (error.code() != ExitCode::bad_input) throw std::logic_error(error.what());
    return false;
  }
  try {
    scene::validate(loaded);
  } catch (const Error& error) {
    const bool is_gltf = format == "gltf" || format == "glb";
    if (is_gltf && error.code() == ExitCode::bad_input) return false;
    throw std::logic_error(std::string("the loader returned an invalid scene: ") + error.what());
  }
  return true;
}

// A folder for the bytes, removed in the end: in TMPDIR, else on the RAM disk where there is one, which is
// many times faster for so many small files.
class ScratchFolder {
 public:
  ScratchFolder() {
    const std::filesystem::path ram_disk = "/dev/shm";
    const bool use_ram_disk = std::getenv("TMPDIR") == nullptr && ::access(ram_disk.c_str(), W_OK) == 0;
    const std::filesystem::path parent = use_ram_disk ? ram_disk : std::filesystem::temp_directory_path();
    std::string name = (parent / "lodestone-fuzz-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace lodestone::fuzz
