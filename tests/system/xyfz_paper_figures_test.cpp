// What the paper shows besides its campaign (docs/papers/xyfz.md), on the simulated machine: its
// readings at several levers, and PNP as its models predict it.

#include <gtest/gtest.h>

#include <cmath>

#include "host_sim/experiments/xyfz/paper_figures.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/temporary_folder.hpp"

namespace volcomp::sim {
namespace {

constexpr std::size_t kDraws = 200;

class XyfzPaperFigures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    xyfz::XyfzOptions options;
    options.machine = host::bundled_machine("xyfz");
    bench = std::make_unique<xyfz::Bench>(options, [](double, const std::string&) {});
  }
  static void TearDownTestSuite() { bench.reset(); }

  // Carried to one point, with the noise of the instrument, by draw.
  static std::vector<double> carried_um(const xyfz::LeverExperiment& experiment) {
    std::vector<double> carried(kDraws);
    host::in_parallel(kDraws, host::processors(), [&](std::size_t draw) {
      carried[draw] = xyfz::measure_levers(*bench, experiment, xyfz::LeverNoise::instrument, draw)
                          .carried_apart_um();
    });
    return carried;
  }

  // True angle of X, mean of both directions, rad.
  static double angle(double q, Eigen::Index channel) {
    return 0.5 * (bench->truth.relative_error(0, q, 1.0)(channel) +
                  bench->truth.relative_error(0, q, -1.0)(channel));
  }

  static inline std::unique_ptr<xyfz::Bench> bench;
};

// Eq. 5: what the heights differ by is their distance times the pitch since machine zero; eq. 6:
// sideways it is the yaw, with the other sign.
TEST_F(XyfzPaperFigures, ReadingsDifferByAngleTimesDistance) {
  const auto [heights, sideways] = xyfz::lever_experiments();
  const auto up = xyfz::measure_levers(*bench, heights, xyfz::LeverNoise::none, 0);
  const auto side = xyfz::measure_levers(*bench, sideways, xyfz::LeverNoise::none, 0);
  ASSERT_EQ(up.position_mm.size(), 11U);
  for (std::size_t t = 0; t < up.position_mm.size(); ++t) {
    const double q = up.position_mm[t];
    EXPECT_NEAR(up.measured[2][t] - up.measured[0][t],
                300.0 * kUmPerMm * (angle(q, 4) - angle(0.0, 4)), 0.01)
        << q;
    EXPECT_NEAR(side.measured[1][t] - side.measured[0][t],
                -290.0 * kUmPerMm * (angle(q, 5) - angle(0.0, 5)), 0.01)
        << q;
  }
  EXPECT_GT(up.measured_apart_um(), 1.0);
  EXPECT_GT(side.measured_apart_um(), 1.0);
}

TEST_F(XyfzPaperFigures, CarriedToOnePointTheyAgreeWithoutNoise) {
  for (const xyfz::LeverExperiment& e : xyfz::lever_experiments()) {
    const auto readings = xyfz::measure_levers(*bench, e, xyfz::LeverNoise::none, 0);
    EXPECT_LT(readings.carried_apart_um(), 0.005) << e.name;
    EXPECT_EQ(readings.test, Reason::ok) << e.name;
    EXPECT_NEAR(readings.found_mm, e.lever_mm(), 0.5) << e.name;
  }
}

// The reference, another program, found 1.1 (95 %: 1.7) and 0.9 (1.4) µm with the same classes.
TEST_F(XyfzPaperFigures, WithNoiseTheyAgreeAsInTheReference) {
  const auto [heights, sideways] = xyfz::lever_experiments();
  const std::vector<double> up = carried_um(heights);
  EXPECT_NEAR(xyfz::quantile(up, 0.5), 1.1, 0.2);
  EXPECT_NEAR(xyfz::quantile(up, 0.95), 1.7, 0.3);
  const std::vector<double> side = carried_um(sideways);
  EXPECT_NEAR(xyfz::quantile(side, 0.5), 0.9, 0.2);
  EXPECT_NEAR(xyfz::quantile(side, 0.95), 1.4, 0.3);
}

// The raw figures are tuned to the paper's, the prediction of the closed model is not.
TEST_F(XyfzPaperFigures, PredictsThePapersDiagonal) {
  const host::TemporaryFolder folder;
  xyfz::CheckedCampaign measured = xyfz::noise_free_campaign(*bench, folder.path());
  const xyfz::Prediction p = xyfz::predict_pnp(*bench, measured);
  EXPECT_NEAR(p.measured_max_um(), 41.15, 0.01);
  EXPECT_NEAR(p.left_um(0), 16.37, 0.02);
  EXPECT_LT(p.left_um(2), 0.73);
  for (std::size_t m = 0; m < p.predicted_um.size(); ++m)
    EXPECT_LE(std::abs(p.predicted_max_um(m) - p.measured_max_um()), p.left_um(m)) << m;
}

}  // namespace
}  // namespace volcomp::sim
