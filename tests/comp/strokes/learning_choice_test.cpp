// Which signals are learned from, and which must not be alone.

#include <cmath>
#include <vector>

#include "comp/strokes/learning_choice.hpp"
#include "tests/oracle/internal_gears.hpp"

namespace volcomp::test {
namespace {

TEST(LearningChoice, OneAxisOfAHelixIsRefusedWithItsEffect) {
  const InternalGear gear = paper_gear();
  HelixEffect effect;
  const auto check = [&](LearningTarget target, bool helix, bool forced) {
    return check_learning_target(target, helix, forced, gear.normal_lever(), gear.turn_per_mm,
                                 -0.17, 0.033 * kDegree, effect);
  };
  const Status c_alone = check(LearningTarget::c_alone, true, false);
  EXPECT_EQ(c_alone.reason, Reason::breaks_helix);
  EXPECT_STREQ(c_alone.where.field, "C");
  EXPECT_NEAR(c_alone.where.value, -41.35, 0.005) << "the lag of Z would stay";
  EXPECT_NEAR(effect.z_um, -41.35, 0.005);
  EXPECT_NEAR(effect.c_um, 42.76, 0.005);
  EXPECT_NEAR(effect.together_um, 1.41, 0.005);
  EXPECT_EQ(check(LearningTarget::z_alone, true, false).reason, Reason::breaks_helix);
  EXPECT_TRUE(check(LearningTarget::c_alone, true, true).ok()) << "forced";
  EXPECT_TRUE(check(LearningTarget::c_alone, false, false).ok()) << "nothing follows a helix";
  EXPECT_TRUE(check(LearningTarget::synchronisation, true, false).ok());
  EXPECT_TRUE(check(LearningTarget::z_and_c, true, false).ok());
  EXPECT_EQ(check_learning_target(LearningTarget::synchronisation, true, false, 74.0, 0.003,
                                  std::nan(""), 0.0, effect)
                .reason,
            Reason::not_finite);
}

std::vector<NodeSums> signal(double repeatable, double noise, Random& random) {
  std::vector<NodeSums> nodes(40);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    for (int k = 0; k < 20; ++k)
      nodes[j].add(repeatable * std::sin(0.3 * static_cast<double>(j)) + random.normal(noise));
  }
  return nodes;
}

TEST(LearningChoice, WhatComesBackAndMattersIsCompensated) {
  Random random;
  const auto verdict = [&](double repeatable, double noise) {
    const std::vector<NodeSums> nodes = signal(repeatable, noise, random);
    return judge_signal(repeatability(nodes, 2), 1.0, 10.0, 0.2);
  };
  EXPECT_EQ(verdict(5.0, 0.5), LearningVerdict::compensate);
  EXPECT_EQ(verdict(1.0, 0.1), LearningVerdict::too_small) << "for the tolerance";
  EXPECT_EQ(verdict(0.0, 20.0), LearningVerdict::not_significant) << "report, do not learn";
  const std::vector<NodeSums> exact = signal(5.0, 0.0, random);
  const Repeatability r = repeatability(exact, 2);
  EXPECT_NEAR(r.amplitude, 5.0, 0.1);
  EXPECT_NEAR(r.ratio, 1.0, 1e-9);
}

TEST(LearningChoice, TheTwoFlanksTellCFromX) {
  const double lever = paper_gear().normal_lever();
  const double e_c = 2e-5;
  const double e_x = -0.004;
  const FlankPairErrors found =
      errors_of_flank_pair(lever * e_c - 0.3246 * e_x, -lever * e_c - 0.3246 * e_x, lever, 0.3246);
  EXPECT_NEAR(found.e_c, e_c, 1e-18);
  EXPECT_NEAR(found.e_x, e_x, 1e-16);
}

}  // namespace
}  // namespace volcomp::test
