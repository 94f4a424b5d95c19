// SPDX-License-Identifier: MIT
// Small files for the tests of the loaders, and what they say about broken ones.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "lodestone/base/error.h"
#include "lodestone/scene/load.h"

namespace lodestone::scene::test {

// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lodestone-scene-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes a file, its folders as well; returns its path.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + file.string());
    return file;
  }

 private:
  std::filesystem::path path_;
};

// The loader that the extension calls for.
inline Scene load_by_extension(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".obj") return load_obj(path);
  if (extension == ".ply") return load_ply(path);
  if (extension == ".stl") return load_stl(path);
  return load_height_map(path, {});
}

// The scene in the file, which has to be a valid one of a single mesh under a single node.
inline Scene load_valid(const std::filesystem::path& path) {
  Scene scene = load_by_extension(path);
  validate(scene);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.nodes.size(), 1u);
  EXPECT_EQ(scene.nodes.at(0).mesh, 0u);
  return scene;
}

inline Mesh load_mesh(const std::filesystem::path& path) {
  return load_valid(path).meshes.at(0);
}

// The message of the Error(bad_input) with which loading the file has to end, without the file's name.
inline std::string bad_input_message(const std::filesystem::path& path) {
  try {
    load_by_extension(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
    const std::string message = error.what(), subject = path.string() + ": ";
    EXPECT_TRUE(message.starts_with(subject)) << message;
    return message.substr(std::min(message.size(), subject.size()));
  }
  ADD_FAILURE() << path << " was loaded";
  return {};
}

inline testing::AssertionResult near(const glm::vec3& actual, const glm::vec3& expected,
                                     float tolerance = 1e-6f) {
  if (glm::all(glm::lessThanEqual(glm::abs(actual - expected), glm::vec3(tolerance)))) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "(" << actual.x << ", " << actual.y << ", " << actual.z
                                     << ") is not (" << expected.x << ", " << expected.y << ", " << expected.z
                                     << ")";
}

}  // namespace lodestone::scene::test
