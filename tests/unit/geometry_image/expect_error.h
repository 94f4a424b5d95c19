// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "lodestone/base/error.h"

namespace lodestone::geometry_image::test {

// `action` must throw an Error of that code whose text starts with `subject` and mentions `because`.
template <class Action>
void expect_error(const Action& action, ExitCode code, const std::string& subject,
                  const std::string& because) {
  try {
    action();
    ADD_FAILURE() << "no error; expected: " << because;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_TRUE(std::string(error.what()).starts_with(subject + ": ")) << error.what();
    EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
  }
}

}  // namespace lodestone::geometry_image::test
