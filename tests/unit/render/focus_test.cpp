// SPDX-License-Identifier: MIT
#include "lodestone/render/focus.h"

#include <gtest/gtest.h>

#include <bit>

#include "lodestone/layout/atlas.h"

namespace lodestone::render {
namespace {

View wide_view() {
  View view;
  view.right = {2, 0, 0};
  view.up = {0, 1, 0};
  return view;
}

// All of what lies in the planes at these distances, in the middle and beside it.
float focus_on(const View& view, float middle, float beside) {
  const std::vector<glm::vec4> rays = focus_rays(view);
  std::vector<glm::uvec4> hits;
  for (size_t i = 0; i < rays.size(); i += 2) {
    const glm::vec3 direction(rays[i + 1]), from = glm::vec3(rays[i]) - view.origin;
    const glm::vec3 at = view.perspective ? direction / -direction.z : from;
    const bool is_middle = std::abs(at.x) < 2 / 3.0f && std::abs(at.y) < 1 / 3.0f;
    const float distance = is_middle ? middle : beside;
    const bool hit = distance > 0;
    hits.emplace_back(std::bit_cast<uint32_t>(distance / -direction.z), 0, 0, hit ? 7 : layout::no_index);
  }
  return focus_of(view, rays, hits);
}

TEST(Focus, IsOnTheNearestInTheMiddleOfThePicture) {
  for (const bool perspective : {true, false}) {
    View view = wide_view();
    view.perspective = perspective;
    view.origin = {1, 2, 3};
    EXPECT_NEAR(focus_on(view, 4, 1), 4, 1e-5f);
    EXPECT_NEAR(focus_on(view, 1, 4), 1, 1e-5f);
  }
}

TEST(Focus, IsOnWhatIsBesideTheMiddleWhereNothingIsInIt) {
  EXPECT_NEAR(focus_on(wide_view(), 0, 5), 5, 1e-5f);
}

TEST(Focus, IsFarAwayWhereNothingIs) {
  EXPECT_GT(focus_on(wide_view(), 0, 0), 1e5f);
}

}  // namespace
}  // namespace lodestone::render
