// SPDX-License-Identifier: MIT
// Notes and warnings on standard error. Quiet under `-q`, more under `-v`.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace lodestone::log {

enum class Level { quiet, normal, verbose };

void set_level(Level level);
Level level();

// `lodestone: warning: MESSAGE`, unless quiet.
void warn(const std::string& message);
// The same, but a message whose `key` was warned of before in this process is dropped.
void warn_once(const std::string& key, const std::string& message);
// `lodestone: MESSAGE`, only when verbose.
void note(const std::string& message);

}  // namespace lodestone::log
