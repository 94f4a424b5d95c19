// SPDX-License-Identifier: MIT
// What this program is.
#pragma once

namespace lodestone::app {

const char* version();  // "0.1.0"
const char* commit();   // the git commit it was built from, or "unknown"

}  // namespace lodestone::app
