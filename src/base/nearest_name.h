// SPDX-License-Identifier: MIT
// For messages: what somebody may have meant.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lodestone {

// The one of `names` that the fewest letters tell from `name`, a third of its own at most (upper or lower
// case does not count); the first of equals.
std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> names);

}  // namespace lodestone
