// ISO 230-2 figures against an example worked by hand.

#include <vector>

#include <gtest/gtest.h>

#include "comp/metrology/tables/iso230.hpp"

namespace volcomp::test {
namespace {

// Three targets, µm. Up means 0, 2, 5 with s 0.5, 1, 0.25; down means −1, 4, 1 with s 0.5, 0.25, 2.
struct Example {
  std::vector<double> up{0, 2, 5}, s_up{0.5, 1, 0.25};
  std::vector<double> down{-1, 4, 1}, s_down{0.5, 0.25, 2};

  [[nodiscard]] DirectionStatistics rising() { return {up, s_up}; }
  [[nodiscard]] DirectionStatistics falling() { return {down, s_down}; }
};

TEST(Iso230, WorkedExample) {
  Example e;
  Iso230Figures f;
  ASSERT_TRUE(iso230_figures(e.rising(), e.falling(), f).ok());
  EXPECT_EQ(f.B, 4.0);       // B_i = 1, −2, 4
  EXPECT_EQ(f.E, 6.0);       // means −1 … 5
  EXPECT_EQ(f.M, 3.5);       // (0−1)/2, (2+4)/2, (5+1)/2 = −0.5, 3, 3
  EXPECT_EQ(f.R_up, 4.0);    // 4 · 1
  EXPECT_EQ(f.R_down, 8.0);  // 4 · 2
  EXPECT_EQ(f.R, 8.5);       // third target: 2·0.25 + 2·2 + 4
  EXPECT_EQ(f.A_up, 6.5);    // −1 … 5.5
  EXPECT_EQ(f.A_down, 8.0);  // −3 … 5
  EXPECT_EQ(f.A, 8.5);       // −3 … 5.5
}

TEST(Iso230, RepeatabilityOfOneDirectionCanDecide) {
  Example e;
  e.s_up = {0, 5, 0};
  Iso230Figures f;
  ASSERT_TRUE(iso230_figures(e.rising(), e.falling(), f).ok());
  EXPECT_EQ(f.R, 20.0);  // 4·5 > 2·5 + 2·0.25 + 2
}

TEST(Iso230, ConstantShiftChangesNothing) {
  Example a;
  Example b;
  for (auto* values : {&b.up, &b.down}) {
    for (double& v : *values)
      v += 1024.0;
  }
  Iso230Figures fa;
  Iso230Figures fb;
  ASSERT_TRUE(iso230_figures(a.rising(), a.falling(), fa).ok());
  ASSERT_TRUE(iso230_figures(b.rising(), b.falling(), fb).ok());
  EXPECT_EQ(fa.A, fb.A);
  EXPECT_EQ(fa.E, fb.E);
  EXPECT_EQ(fa.M, fb.M);
  EXPECT_EQ(fa.R, fb.R);
  EXPECT_EQ(fa.B, fb.B);
}

TEST(Iso230, OneDirectionGivenTwiceHasNoReversal) {
  Example e;
  Iso230Figures f;
  ASSERT_TRUE(iso230_figures(e.rising(), e.rising(), f).ok());
  EXPECT_EQ(f.B, 0.0);
  EXPECT_EQ(f.A, f.A_up);
  EXPECT_EQ(f.R, f.R_up);
}

TEST(Iso230, RefusesNothingAndUnequalLengths) {
  Example e;
  Iso230Figures f;
  f.A = 7.0;
  EXPECT_EQ(iso230_figures({}, {}, f).reason, Reason::too_few_points);
  e.s_down.pop_back();
  EXPECT_EQ(iso230_figures(e.rising(), e.falling(), f).reason, Reason::too_few_points);
  e = {};
  e.down.pop_back();
  EXPECT_EQ(iso230_figures(e.rising(), e.falling(), f).reason, Reason::too_few_points);
  EXPECT_EQ(f.A, 7.0) << "written on refusal";
}

}  // namespace
}  // namespace volcomp::test
