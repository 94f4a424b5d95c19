// SPDX-License-Identifier: MIT
// The addresses of buffers and images (2.8): relative paths and data URIs (RFC 3986, RFC 2397).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::scene {

// `text` with every %XX replaced by the byte it stands for; a % that begins no such thing is itself, and so
// is a plus sign.
std::string percent_decoded(std::string_view text);

bool is_data_uri(std::string_view uri);

// The bytes of a data URI of any media type, base64 or not; nothing where it is malformed.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri);

}  // namespace lodestone::scene
