// Circles whose errors are known, read by a bar whose socket is not in the middle.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "comp/metrology/circles/circle_decomposition.hpp"
#include "comp/metrology/circles/circle_figures.hpp"

namespace volcomp {
namespace {

constexpr double kRadius = 100.0;
constexpr std::size_t kReadings = 360;
constexpr double kStep = 6.283185307179586 / kReadings;

// Both directions of a path (x, y)(θ, sense), read about `socket`.
class Circle {
 public:
  template <class Path>
  Circle(const Path& path, double socket_x, double socket_y) {
    for (std::size_t i = 0; i < kReadings; ++i) {
      ccw_[i] = kStep * static_cast<double>(i);
      cw_[i] = kStep * static_cast<double>(kReadings - i);
      const auto read = [&](double theta, double sense) {
        const std::array<double, 2> at = path(theta, sense);
        return std::hypot(at[0] - socket_x, at[1] - socket_y) - kRadius;
      };
      ccw_radial_[i] = read(ccw_[i], 1.0);
      cw_radial_[i] = read(cw_[i], -1.0);
    }
  }
  [[nodiscard]] CircleTest test() const {
    return {kRadius, {ccw_, ccw_radial_}, {cw_, cw_radial_}};
  }
  [[nodiscard]] CircleDecomposition decomposed() const {
    CircleSettings settings;
    settings.feed = 1000.0 / 60.0;
    CircleDecomposition d;
    EXPECT_TRUE(decompose_circle(test(), settings, {}, d).ok());
    return d;
  }

 private:
  std::array<double, kReadings> ccw_{}, cw_{}, ccw_radial_{}, cw_radial_{};
};

std::array<double, 2> on_circle(double theta) {
  return {kRadius * std::cos(theta), kRadius * std::sin(theta)};
}

// A socket half a millimetre off and axes that are not square: x moves along with y.
TEST(CircleDecomposition, FindsSquarenessAboutASocketFarOff) {
  constexpr double kSlope = 20e-6;
  const auto path = [](double theta, double /*sense*/) {
    std::array<double, 2> at = on_circle(theta);
    at[0] += kSlope * at[1];
    return at;
  };
  const CircleDecomposition d = Circle(path, 0.3, -0.4).decomposed();
  EXPECT_NEAR(d.value.squareness, -kSlope, 1e-9);
  // The path is no circle: its centre is known to slope times offset.
  EXPECT_NEAR(d.value.centre[0], 0.3, kSlope * 0.5);
  EXPECT_NEAR(d.value.centre[1], -0.4, kSlope * 0.5);
  EXPECT_NEAR(d.value.scale_mismatch, 0.0, 1e-9);
  EXPECT_NEAR(d.value.servo_mismatch, 0.0, 1e-6);
}

// An axis that lags is behind in either direction of the path.
TEST(CircleDecomposition, TellsLagFromSquarenessByTheDirection) {
  constexpr double kLag = 1e-3;  // s
  const auto path = [](double theta, double sense) {
    constexpr double kTurning = 1000.0 / 60.0 / kRadius;  // rad/s
    return std::array<double, 2>{kRadius * std::cos(theta - sense * kTurning * kLag),
                                 kRadius * std::sin(theta)};
  };
  const CircleDecomposition d = Circle(path, 0.0, 0.0).decomposed();
  EXPECT_NEAR(d.value.servo_mismatch, kLag, 1e-6);
  EXPECT_NEAR(d.value.squareness, 0.0, 1e-9);
}

// The standard's picture of backlash: where an axis turns, the path steps by it.
TEST(CircleDecomposition, FindsTheReversalOfOneAxis) {
  constexpr double kReversal = 5e-3;
  const auto path = [](double theta, double sense) {
    std::array<double, 2> at = on_circle(theta);
    const double rising = -sense * std::sin(theta);
    if (std::abs(rising) > 1e-9) at[0] += rising > 0.0 ? 0.5 * kReversal : -0.5 * kReversal;
    return at;
  };
  const CircleDecomposition d = Circle(path, 0.0, 0.0).decomposed();
  EXPECT_NEAR(d.value.reversal[0], kReversal, 1e-6);
  EXPECT_NEAR(d.value.reversal[1], 0.0, 1e-6);
}

TEST(CircleFigures, OfACircleBesideTheSocketAreThoseOfACircle) {
  const auto path = [](double theta, double /*sense*/) { return on_circle(theta); };
  CircleFigures f;
  ASSERT_TRUE(circle_figures(Circle(path, 0.3, -0.4).test(), f).ok());
  EXPECT_NEAR(f.circular, 0.0, 1e-11);
  EXPECT_NEAR(f.radius_deviation, 0.0, 1e-11);
  EXPECT_NEAR(f.radial_max, 0.5, 1e-4) << "the instrument sees how far off its socket is";
}

}  // namespace
}  // namespace volcomp
