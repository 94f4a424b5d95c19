// SPDX-License-Identifier: MIT
#include "lodestone/base/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodestone {
namespace {

const std::vector<std::string> names = {"jawOpen", "jawLeft", "mouthSmile_L", "x"};

TEST(NearestName, IsTheOneWithTheFewestLettersToChange) {
  EXPECT_EQ(nearest_name("jawopen", names), "jawOpen");
  EXPECT_EQ(nearest_name("jawLfet", names), "jawLeft");
  EXPECT_EQ(nearest_name("mouthSmileL", names), "mouthSmile_L");
  EXPECT_EQ(nearest_name("y", names), "x");
}

TEST(NearestName, IsNoneWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("browDown", names), std::nullopt);
  EXPECT_EQ(nearest_name("jawOpen", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(1 << 20, 'a'), names), std::nullopt);
}

}  // namespace
}  // namespace lodestone
