// SPDX-License-Identifier: MIT
// The classes of CLI11 that declarations name: the whole of it takes seconds to compile.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI
