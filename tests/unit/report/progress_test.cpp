// SPDX-License-Identifier: MIT
#include "lodestone/report/progress.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lodestone::report {
namespace {

// A terminal or file and a clock that the test owns.
struct Fake {
  std::string text;
  double now = 100;

  Progress::Output output(bool terminal) {
    return {[this](const std::string& more) { text += more; }, terminal, [this] { return now; }};
  }
};

TEST(Progress, JsonIsALineAFrameWithTheTimeLeft) {
  Fake fake;
  {
    Progress progress(ProgressMode::json, 4, fake.output(false));
    fake.now += 2;
    progress.frame_done();
    fake.now += 4;
    progress.frame_done();
  }
  EXPECT_EQ(fake.text,
            "{\"frame\":1,\"frames\":4,\"seconds_left\":6.000}\n"
            "{\"frame\":2,\"frames\":4,\"seconds_left\":6.000}\n");
}

TEST(Progress, TheTimeLeftCountsDownWithinAFrame) {
  Fake fake;
  Progress progress(ProgressMode::automatic, 3, fake.output(true));
  fake.now += 60;
  progress.frame_done();
  fake.now += 20;
  progress.tick();
  EXPECT_NE(fake.text.find("1:40 left"), std::string::npos) << fake.text;
  fake.now += 200;  // a frame that takes longer than all before
  progress.tick();
  EXPECT_NE(fake.text.find("0:00 left"), std::string::npos) << fake.text;
}

TEST(Progress, RedrawsOneLineOfATerminalAndClearsIt) {
  Fake fake;
  {
    Progress progress(ProgressMode::automatic, 2, fake.output(true));
    fake.now += 75;
    progress.frame_done();
  }
  EXPECT_EQ(fake.text.find('\n'), std::string::npos);
  EXPECT_EQ(fake.text.rfind("\rframe 1 of 2, 50 %, 1:15 left", 0), 0u);
  EXPECT_EQ(fake.text.back(), '\r');
}

TEST(Progress, RedrawsNoMoreThanTenTimesASecond) {
  Fake fake;
  Progress progress(ProgressMode::automatic, 2, fake.output(true));
  for (int i = 0; i < 100; ++i) {
    fake.now += 0.01;
    progress.tick();
  }
  EXPECT_LE(std::count(fake.text.begin(), fake.text.end(), '\r'), 10);
  EXPECT_GE(std::count(fake.text.begin(), fake.text.end(), '\r'), 8);
}

TEST(Progress, WritesPlainLinesNowAndThenWhereThereIsNoTerminal) {
  Fake fake;
  {
    Progress progress(ProgressMode::automatic, 100, fake.output(false));
    for (int i = 0; i < 25; ++i) {
      fake.now += 1;
      progress.frame_done();
      progress.tick();
    }
  }
  EXPECT_EQ(fake.text,
            "lodestone: frame 10 of 100, 10 %, 1:30 left\n"
            "lodestone: frame 20 of 100, 20 %, 1:20 left\n");
}

TEST(Progress, SaysNothingWhenOff) {
  Fake fake;
  {
    Progress progress(ProgressMode::off, 1, fake.output(true));
    fake.now += 100;
    progress.tick();
    progress.frame_done();
  }
  EXPECT_EQ(fake.text, "");
}

TEST(DurationText, CountsMinutesAndHours) {
  EXPECT_EQ(duration_text(0.2), "0:00");
  EXPECT_EQ(duration_text(75), "1:15");
  EXPECT_EQ(duration_text(3675), "1:01:15");
}

}  // namespace
}  // namespace lodestone::report
