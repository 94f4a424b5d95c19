// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "lodestone/app/describe.h"
#include "lodestone/base/plain_line.h"

namespace lodestone::app {
namespace {

using Json = nlohmann::ordered_json;

std::string words(std::string key) {
  if (key.find(':') == std::string::npos) std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

// No more digits than people read, and none fewer than a float has: JSON has them all.
std::string number(const Json& value) {
  std::string exact = value.dump(), rounded = fmt::format("{:.7g}", value.get<double>());
  return rounded.size() < exact.size() && exact.size() > 8 ? rounded : exact;
}

// On one line: numbers and texts as they are, arrays and objects in brackets.
std::string inline_text(const Json& value) {
  if (value.is_string()) return plain_line(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "none";
  if (value.is_number_float()) return number(value);
  if (!value.is_structured()) return value.dump();
  if (value.empty()) return "none";
  std::string text;
  for (const auto& [key, item] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += words(key) + ' ';
    text +=
        item.is_structured() && !item.empty() ? fmt::format("({})", inline_text(item)) : inline_text(item);
  }
  return text;
}

bool holds_objects(const Json& value) {
  return value.is_array() && !value.empty() && value[0].is_object();
}

// An element of an array of objects: its name, then the rest.
std::string element_line(const Json& element, size_t index) {
  const std::string name = element.value("name", "");
  Json rest = element;
  rest.erase("name");
  return std::to_string(index) + ' ' + (name.empty() ? "(no name)" : plain_line(name)) + ": " +
         inline_text(rest);
}

bool holds_sentences(const Json& value) {
  return value.is_array() && !value.empty() && std::all_of(value.begin(), value.end(), [](const Json& item) {
           return item.is_string() && item.get_ref<const std::string&>().ends_with('.');
         });
}

void print(const Json& object, const std::string& indent, std::string& text) {
  for (const auto& [key, value] : object.items()) {
    text += indent + plain_line(words(key)) + ':';
    if (value.is_object() && !value.empty()) {
      text += '\n';
      print(value, indent + "  ", text);
    } else if (holds_objects(value)) {
      text += fmt::format(" {}\n", value.size());
      for (size_t i = 0; i < value.size(); ++i) text += indent + "  " + element_line(value[i], i) + '\n';
    } else if (holds_sentences(value)) {
      text += '\n';
      for (const Json& sentence : value) text += indent + "  " + inline_text(sentence) + '\n';
    } else {
      text += ' ' + inline_text(value) + '\n';
    }
  }
}

}  // namespace

std::string plain_text(const Json& description) {
  std::string text;
  print(description, "", text);
  return text;
}

}  // namespace lodestone::app
