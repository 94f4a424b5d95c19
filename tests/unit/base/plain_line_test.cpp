// SPDX-License-Identifier: MIT
#include "lodestone/base/plain_line.h"

#include <gtest/gtest.h>

#include "lodestone/base/log.h"

namespace lodestone {
namespace {

TEST(PlainLine, HasNoControlCharacters) {
  EXPECT_EQ(plain_line("a\nb\x1b[2Jc\td\x7f"), "a?b?[2Jc?d?");
  EXPECT_EQ(plain_line(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(plain_line("a\xc2\x9b"
                       "2J\xc2\x80"),
            "a?2J?");
}

TEST(PlainLine, KeepsEverythingElse) {
  EXPECT_EQ(plain_line(""), "");
  for (const char* text : {"plain", "grün \xc2\xa0", "ゆき", "\xc2", "\xff broken"})
    EXPECT_EQ(plain_line(text), text);
}

TEST(PlainLine, IsWhatWarningsAndNotesAre) {
  const log::Level before = log::level();
  log::set_level(log::Level::verbose);
  testing::internal::CaptureStderr();
  log::warn("a\nlodestone: error: b\x1b[2J");
  log::warn_once("plain line test", "c\rd");
  log::note("e\x7f");
  const std::string said = testing::internal::GetCapturedStderr();
  log::set_level(before);
  EXPECT_EQ(said, "lodestone: warning: a?lodestone: error: b?[2J\nlodestone: warning: c?d\nlodestone: e?\n");
}

}  // namespace
}  // namespace lodestone
