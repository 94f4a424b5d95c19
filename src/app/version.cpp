// SPDX-License-Identifier: MIT
#include "lodestone/app/version.h"

namespace lodestone::app {

extern const char* const git_commit;  // written by commit.cmake

const char* version() {
  return LODESTONE_VERSION;
}
const char* commit() {
  return git_commit;
}

}  // namespace lodestone::app
