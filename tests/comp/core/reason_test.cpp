// Every reason has its own code and its own sentence.

#include <set>
#include <string>

#include <gtest/gtest.h>
#include "comp/core/status.hpp"

namespace volcomp::test {
namespace {

constexpr int kReasons = static_cast<int>(Reason::run_count_differs) + 1;

TEST(Reason, CodesAndSentencesAreDistinct) {
  std::set<std::string> codes;
  std::set<std::string> sentences;
  for (int i = 0; i < kReasons; ++i) {
    const auto reason = static_cast<Reason>(i);
    EXPECT_TRUE(codes.insert(code(reason)).second) << code(reason);
    EXPECT_TRUE(sentences.insert(sentence(reason)).second) << sentence(reason);
  }
}

TEST(Reason, CodesAreIdentifiersAndSentencesAreSentences) {
  for (int i = 0; i < kReasons; ++i) {
    const std::string name = code(static_cast<Reason>(i));
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos)
        << name;
    const std::string text = sentence(static_cast<Reason>(i));
    ASSERT_GT(text.size(), 8U) << name;
    EXPECT_EQ(text.back(), '.') << name;
    EXPECT_TRUE(text.front() >= 'A' && text.front() <= 'Z') << name;
  }
}

// A node carries the sentences for what images and settings can be refused for, and no others.
TEST(Reason, LoadingSentencesAreThoseOfAnImage) {
  for (const Reason reason :
       {Reason::ok, Reason::not_finite, Reason::too_few_knots, Reason::too_many_knots,
        Reason::pitch_not_positive, Reason::travel_too_long, Reason::not_periodic,
        Reason::bad_magic, Reason::crc_mismatch, Reason::axes_mismatch, Reason::bound_exceeded,
        Reason::bad_axis_index, Reason::no_authority, Reason::bad_setting, Reason::not_staged,
        Reason::hand_over_pending, Reason::bad_thermal, Reason::expired, Reason::cannot_orient})
    EXPECT_STREQ(loading_sentence(reason), sentence(reason)) << code(reason);
  for (const Reason reason :
       {Reason::no_runs, Reason::gap_too_large, Reason::unit_suspected, Reason::lever_mismatch,
        Reason::too_few_points, Reason::length_mismatch, Reason::not_converged})
    EXPECT_EQ(loading_sentence(reason), nullptr) << code(reason);
}

TEST(Reason, StableNames) {
  EXPECT_STREQ(code(Reason::ok), "ok");
  EXPECT_STREQ(code(Reason::crc_mismatch), "crc_mismatch");
  EXPECT_STREQ(code(Reason::axes_mismatch), "axes_mismatch");
  EXPECT_STREQ(code(Reason::not_staged), "not_staged");
}

}  // namespace
}  // namespace volcomp::test
