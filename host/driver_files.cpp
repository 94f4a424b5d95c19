// SPDX-License-Identifier: MIT
#include "lodestone/host/driver_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace lodestone::host {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> split_paths(std::string_view text) {
  std::vector<fs::path> paths;
  while (!text.empty()) {
    const size_t colon = std::min(text.find(':'), text.size());
    if (colon > 0) paths.emplace_back(text.substr(0, colon));
    text.remove_prefix(std::min(colon + 1, text.size()));
  }
  return paths;
}

// The loader's search path; see "Driver Discovery on Linux" in its documentation.
std::vector<fs::path> driver_folders() {
  const auto variable = [](const char* name, std::string_view otherwise) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr && *value != 0 ? value : otherwise);
  };
  const std::string home = variable("HOME", "");
  const auto below_home = [&](const char* folder) {
    return home.empty() ? home : fmt::format("{}/{}", home, folder);
  };
  const std::string roots = fmt::format(
      "{}:{}:/etc:{}:{}", variable("XDG_CONFIG_HOME", below_home(".config")),
      variable("XDG_CONFIG_DIRS", "/etc/xdg"), variable("XDG_DATA_HOME", below_home(".local/share")),
      variable("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
  std::vector<fs::path> folders;
  for (const fs::path& root : split_paths(roots)) folders.push_back(root / "vulkan/icd.d");
  return folders;
}

// The file's name, and what is wrong with it if anything is.
std::string describe(const fs::path& file) {
  std::ifstream in(file);
  if (!in) return file.string() + (fs::exists(file) ? " (cannot be read)" : " (does not exist)");
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const auto library =
      json.is_discarded() ? nlohmann::json() : json.value("/ICD/library_path"_json_pointer, nlohmann::json());
  if (!library.is_string()) return file.string() + " (is no driver file)";
  // A bare name is looked up by the dynamic linker, a path is relative to the file.
  const fs::path path = library.get<std::string>();
  if (path.has_parent_path() && !fs::exists(file.parent_path() / path)) {
    return fmt::format("{} (its library {} does not exist)", file.string(), path.string());
  }
  return file.string();
}

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string describe_driver_files() {
  std::vector<std::string> found;
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    const char* value = std::getenv(name);
    if (value == nullptr) continue;
    if (*value == 0) return fmt::format("{} is set and names no driver file", name);
    for (const fs::path& path : split_paths(value)) {
      if (fs::is_directory(path)) {
        for (const fs::path& file : json_files(path)) found.push_back(describe(file));
      } else {
        found.push_back(describe(path));
      }
    }
    return fmt::format("driver files tried, from {}: {}", name, fmt::join(found, "; "));
  }
  std::vector<std::string> searched;
  for (const fs::path& folder : driver_folders()) {
    searched.push_back(folder.string());
    for (const fs::path& file : json_files(folder)) found.push_back(describe(file));
  }
  if (!found.empty()) return fmt::format("driver files tried: {}", fmt::join(found, "; "));
  return fmt::format("no driver file in {}; a software driver is in the package mesa-vulkan-drivers",
                     fmt::join(searched, ", "));
}

}  // namespace lodestone::host
