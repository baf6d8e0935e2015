// What the evaluation of a circle refuses, and that it writes nothing then.

#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "comp/metrology/circles/circle_decomposition.hpp"
#include "comp/metrology/circles/circle_figures.hpp"

namespace volcomp {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class CircleRefusals : public testing::Test {
 protected:
  CircleRefusals() {
    for (std::size_t i = 0; i < theta_.size(); ++i)
      theta_[i] = 0.1 * static_cast<double>(i);
    settings_.feed = 10.0;
  }
  [[nodiscard]] CircleTest test() const { return {100.0, {theta_, radial_}, {theta_, radial_}}; }
  void expect(const CircleTest& test, Reason reason, const char* field) {
    CircleDecomposition d;
    d.rms = 7.0;
    const Status s = decompose_circle(test, settings_, {}, d);
    EXPECT_EQ(s.reason, reason) << code(s.reason);
    EXPECT_STREQ(s.where.field, field);
    EXPECT_EQ(d.rms, 7.0);  // NOLINT: untouched
  }

  std::array<double, 63> theta_{};
  std::array<double, 63> radial_{};
  CircleSettings settings_;
};

TEST_F(CircleRefusals, Settings) {
  CircleTest bad = test();
  bad.radius = 0.0;
  expect(bad, Reason::bad_setting, "radius");
  settings_.second = settings_.first;
  expect(test(), Reason::bad_setting, "first");
  settings_ = {};
  expect(test(), Reason::bad_setting, "feed");
  settings_.feed = 10.0;
  settings_.cyclic_wavelength = {0.0, -1.0};
  expect(test(), Reason::bad_setting, "cyclic_wavelength");
}

TEST_F(CircleRefusals, Readings) {
  CircleTest short_one = test();
  short_one.cw.radial = {radial_.data(), 10};
  expect(short_one, Reason::length_mismatch, nullptr);
  radial_[7] = kNaN;
  expect(test(), Reason::not_finite, "radial");
  theta_[3] = kNaN;
  expect(test(), Reason::not_finite, "theta");
}

TEST_F(CircleRefusals, TooFewReadings) {
  const CircleTest few{100.0, {{theta_.data(), 20}, {radial_.data(), 20}}, {}};
  expect(few, Reason::too_few_points, nullptr);
  CircleFigures f;
  const CircleTest two{100.0, {{theta_.data(), 2}, {radial_.data(), 2}}, {}};
  EXPECT_EQ(circle_figures(two, f).where.count, 2);
}

TEST(CircleSpikes, AreMissingWhereTooFewReadingsAre) {
  const std::array<double, 4> theta{0.0, 0.5, 1.0, 1.5};
  const std::array<double, 4> residual{};
  for (const CircleSpike& spike : circle_spikes(theta, residual))
    EXPECT_FALSE(spike.known);
  EXPECT_FALSE(circle_spikes({}, {})[0].known);
}

}  // namespace
}  // namespace volcomp
