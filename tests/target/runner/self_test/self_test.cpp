// Tests that fail on purpose, one for each thing the runner must notice. Those called Passes… pass,
// all others must be reported; runner_test.sh looks.

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace volcomp::target {
namespace {

TEST(Passes, EveryComparison) {
  const std::string text = "text";
  EXPECT_TRUE(true) << "never shown";
  EXPECT_FALSE(false);
  EXPECT_EQ(text, "text");
  EXPECT_NE(1, 2);
  EXPECT_LT(1, 2);
  EXPECT_LE(2, 2);
  EXPECT_GT(2.0, 1.0);
  EXPECT_GE(2.0, 2.0);
  EXPECT_NEAR(1.0, 1.1, 0.11);
  EXPECT_FLOAT_EQ(1.0F, 1.0F + 4.0F * 0x1p-23F);
  EXPECT_DOUBLE_EQ(-1.0, -1.0 - 4.0 * 0x1p-52);
  EXPECT_STREQ(text.c_str(), "text");
  ASSERT_EQ((std::array<int, 2>{1, 2}), (std::array<int, 2>{1, 2}));
  if (text.empty())
    EXPECT_TRUE(false);
  else
    EXPECT_TRUE(true);
}

TEST(Fails, True) { EXPECT_TRUE(1 > 2) << "shown " << 42; }
TEST(Fails, False) { EXPECT_FALSE(2 > 1); }
TEST(Fails, Equal) { EXPECT_EQ((std::array<int, 2>{1, 2}), (std::array<int, 2>{1, 3})); }
TEST(Fails, NotEqual) { EXPECT_NE(7, 7); }
TEST(Fails, Less) { EXPECT_LT(2, 2); }
TEST(Fails, LessEqual) { EXPECT_LE(3, 2); }
TEST(Fails, Greater) { EXPECT_GT(-1, 1); }
TEST(Fails, GreaterEqual) { EXPECT_GE(1, 2); }
TEST(Fails, Near) { EXPECT_NEAR(1.0, 1.5, 0.25); }
TEST(Fails, NearNotANumber) { EXPECT_NEAR(std::nan(""), 1.0, 1e9); }
TEST(Fails, Float) { EXPECT_FLOAT_EQ(1.0F, 1.0F + 5.0F * 0x1p-23F); }
TEST(Fails, Double) { EXPECT_DOUBLE_EQ(-1.0, 1.0); }
TEST(Fails, NotANumber) { EXPECT_DOUBLE_EQ(std::nan(""), std::nan("")); }
TEST(Fails, Text) { EXPECT_STREQ("one", "other"); }
TEST(Fails, NoText) { EXPECT_STREQ(nullptr, ""); }
TEST(Fails, Twice) {
  EXPECT_TRUE(false);
  EXPECT_EQ(1, 1);
  EXPECT_TRUE(false);
}
TEST(Fails, Added) { ADD_FAILURE() << "added"; }

TEST(Fails, AssertionsEndTheTest) {
  ASSERT_EQ(1, 2) << "the end";
  RecordProperty("reached_after_an_assertion", 1);
}
TEST(Fails, FailEndsTheTest) {
  if (HasFatalFailure()) return;
  FAIL() << "here";
}

void give_up() { FAIL(); }
TEST(Fails, FatalFailuresOfHelpersAreSeen) {
  give_up();
  if (HasFatalFailure()) RecordProperty("helper_gave_up", 1);
}

TEST(Fails, TracesAreNamed) {
  SCOPED_TRACE("outer");
  { SCOPED_TRACE("gone"); }
  SCOPED_TRACE(std::string("inner"));
  EXPECT_EQ(2.5, -0.0);
}

class Fixture : public ::testing::Test {
 protected:
  void SetUp() override { ++set_up; }
  void TearDown() override { RecordProperty("set_up_before_tear_down", set_up); }
  int set_up = 0;
};
TEST_F(Fixture, PassesAfterSetUp) { EXPECT_EQ(set_up, 1); }

class Hopeless : public ::testing::Test {
 protected:
  void SetUp() override { FAIL() << "cannot be set up"; }
};
TEST_F(Hopeless, NeverRuns) { RecordProperty("reached_without_set_up", 1); }

TEST(Passes, AfterAllThose) { EXPECT_FALSE(HasFatalFailure()); }

}  // namespace
}  // namespace volcomp::target
