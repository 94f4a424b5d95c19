// SPDX-License-Identifier: MIT
#include "lodestone/app/devices_command.h"

#include <fmt/format.h>
#include <CLI/App.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "lodestone/app/common_options.h"
#include "lodestone/base/error.h"
#include "lodestone/cpu_fallback/cpu_backend.h"
#include "lodestone/host/device_list.h"
#include "lodestone/host/driver_files.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const host::DeviceDetails& device) {
  Json properties = Json::object();
  for (const host::DeviceProperty& property : device.properties) properties[property.name] = property.value;
  return {{"index", device.index},       {"kind", device.kind},   {"name", device.name},
          {"driver", device.driver},     {"api", device.api},     {"usable", device.unusable.empty()},
          {"unusable", device.unusable}, {"lacks", device.lacks}, {"properties", properties}};
}

std::string json_text(const std::vector<host::DeviceDetails>& devices) {
  Json all = Json::array();
  for (const host::DeviceDetails& device : devices) all.push_back(to_json(device));
  all.push_back({{"index", nullptr},
                 {"kind", "cpu"},
                 {"name", "cpu"},
                 {"driver", nullptr},
                 {"api", nullptr},
                 {"usable", true},
                 {"unusable", Json::array()},
                 {"lacks", Json::array()},
                 {"properties", {{"SIMD", cpu_fallback::simd_target()}}}});
  return Json{{"devices", all}}.dump(2) + "\n";
}

std::string plain_text(const std::vector<host::DeviceDetails>& devices) {
  std::string text;
  for (const host::DeviceDetails& device : devices) {
    text += fmt::format("{}: {}\n  driver: {}, Vulkan {}\n", device.index, device.name, device.driver,
                        device.api);
    for (const host::DeviceProperty& property : device.properties)
      text += fmt::format("  {}: {}\n", property.name, property.value);
    for (const std::string& lack : device.lacks) text += fmt::format("  lacks: {}\n", lack);
    for (const std::string& need : device.unusable)
      text += fmt::format("  cannot be used, for it lacks: {}\n", need);
  }
  if (devices.empty()) text += fmt::format("no Vulkan device; {}\n", host::describe_driver_files());
  return text + fmt::format("cpu: native code, SIMD: {}\n", cpu_fallback::simd_target());
}

}  // namespace

void add_devices_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command =
      app.add_subcommand("devices", "List what there is to run on, and what each device lacks");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON");
  add_log_options(*command);
  command->footer("Example: lodestone devices --json");
  command->callback([json, &run] {
    run = [json] {
      const std::vector<host::DeviceDetails> devices = host::list_devices();
      fmt::print("{}", *json ? json_text(devices) : plain_text(devices));
      return int(ExitCode::done);
    };
  });
}

}  // namespace lodestone::app
