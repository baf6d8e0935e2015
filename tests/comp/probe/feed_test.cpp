// The point does not depend on the feed: the same touch at 10…1000 mm/min, with latches as drives
// make them: 1 nm, 20 ns, 10 µs from contact to edge, 2…8 µs to the latch of an axis.

#include <cmath>

#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

constexpr double kProbeDelay_s = 10e-6;
constexpr std::array<double, 4> kLatchDelay_s{2e-6, 4e-6, 6e-6, 8e-6};
constexpr std::array<double, 5> kFeeds{10.0, 30.0, 100.0, 300.0, 1000.0};  // mm/min

// All axes move at once; `at` is where they stand at the contact, `direction` per axis, unit speed
// of the linear ones.
Touch touch_at_feed(const std::array<double, 4>& at, const std::array<double, 4>& velocity,
                    double clock_s) {
  Touch touch;
  for (std::size_t a = 0; a < 4; ++a) {
    const double delay = kProbeDelay_s + kLatchDelay_s[a];
    const double latch_s = clock_s > 0.0 ? std::ceil(delay / clock_s) * clock_s : delay;
    const double position = at[a] + velocity[a] * latch_s;
    touch.latched[a] = {std::llround(position), velocity[a], Direction::forward};
  }
  return touch;
}

struct Spread {
  double raw_nm = 0.0;
  double corrected_nm = 0.0;
};

Spread spread(double clock_s) {
  ProbeCorrector corrector = probing_corrector();
  ProbeCorrector without = corrector;
  corrector.settings.probe_delay_s = kProbeDelay_s;
  std::copy(kLatchDelay_s.begin(), kLatchDelay_s.end(), corrector.settings.latch_delay_s.begin());
  Random random(20);
  Spread s;
  for (int i = 0; i < 200; ++i) {
    const auto pose = random_probing_pose(random);
    std::array<double, 4> at{};
    for (std::size_t a = 0; a < 4; ++a)
      at[a] = static_cast<double>(pose[a]) + random.in(-0.5, 0.5);
    Vec3 low = Vec3::Constant(1e18);
    Vec3 high = -low;
    Vec3 raw_low = low;
    Vec3 raw_high = high;
    for (const double feed : kFeeds) {
      const double nm_per_s = feed / 60.0 * kNmPerMm;
      // B swings the ball at the same speed, A turns a flank at 60 mm at it.
      const double b = nm_per_s / (kProbeArm.length * kNmPerMm) * kUnitsPerRad;
      const double a = nm_per_s / (60.0 * kNmPerMm) * kUnitsPerRad;
      const Touch touch =
          touch_at_feed(at, {-0.4 * nm_per_s, -0.7 * nm_per_s, -0.5 * b, 0.3 * a}, clock_s);
      const Vec3 point = vec(corrector.correct(touch, {}, {}).workpiece);
      const Vec3 raw = vec(without.correct(touch, {}, {}).workpiece);
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
      raw_low = raw_low.cwiseMin(raw);
      raw_high = raw_high.cwiseMax(raw);
    }
    s.corrected_nm = std::max(s.corrected_nm, (high - low).maxCoeff());
    s.raw_nm = std::max(s.raw_nm, (raw_high - raw_low).maxCoeff());
  }
  return s;
}

TEST(Feed, DoesNotShowInThePoint) {
  const Spread s = spread(20e-9);
  RecordProperty("raw_nm", static_cast<int>(s.raw_nm));
  RecordProperty("corrected_pm", static_cast<int>(1e3 * s.corrected_nm));
  EXPECT_LT(s.corrected_nm, 10.0);
  EXPECT_GT(s.raw_nm, 100.0);
}

// One microsecond of 1000 mm/min is 16.7 nm: shown, not promised.
TEST(Feed, ShowsWhereTheClockIsCoarse) {
  const Spread s = spread(1e-6);
  EXPECT_LT(s.corrected_nm, 30.0);
}

}  // namespace
}  // namespace volcomp::test
