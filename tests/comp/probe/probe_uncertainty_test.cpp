// Uncertainties of a point beside the spread of 10⁵ points whose inputs are drawn at random.

#include <cmath>

#include "tests/oracle/probing_l300g.hpp"

namespace volcomp::test {
namespace {

class Normal {
 public:
  explicit Normal(std::uint64_t offset) : random_(offset) {}
  double operator()() {  // Box and Muller
    const double u = random_.in(1e-12, 1.0);
    return std::sqrt(-2.0 * std::log(u)) * std::cos(random_.in(0.0, 2.0 * kPi));
  }

 private:
  Random random_;
};

ProbeUncertainty example() {
  ProbeUncertainty u;
  u.radius = 180.0;
  u.tool_length = 900.0;
  u.correlation = 0.6;
  u.repeatability = 250.0;
  u.tables = 300.0;
  u.normal = 2e-4;
  u.probe_delay_s = 20e-6;
  u.position = {50.0, 60.0, 1.5e-6, 2e-6};
  u.latch_delay_s = {5e-6, 6e-6, 7e-6, 8e-6};
  return u;
}

Touch moving_touch() {
  Random random(31);
  Touch touch = touch_at(random_probing_pose(random));
  touch.latched[0].velocity = 12e6;
  touch.latched[1].velocity = -9e6;
  touch.latched[2].velocity = 2e10;
  touch.latched[3].velocity = -3e10;
  return touch;
}

// One point with every input off by what was drawn; in double, before any rounding.
Vec3 drawn(const ProbeCorrector& exact, const Touch& touch, const ProbeFeature& feature,
           Normal& normal) {
  const ProbeUncertainty& u = exact.settings.uncertainty;
  MachineDescription machine = probing_machine();
  const double common = normal();
  const double rest = std::sqrt(1.0 - u.correlation * u.correlation);
  const double longer = u.tool_length * common;
  const double thicker = u.radius * (u.correlation * common + rest * normal());

  machine.tool_point[0] -= longer / kNmPerMm;  // the arm points to −X
  ProbeCorrector c = corrector_of(machine);
  c.settings = exact.settings;
  c.settings.probe_delay_s += u.probe_delay_s * normal();
  Touch t = touch;
  for (std::size_t a = 0; a < 4; ++a) {
    c.settings.latch_delay_s[a] += u.latch_delay_s[a] * normal();
    const double units = a < 2 ? 1.0 : kUnitsPerRad;
    t.latched[a].position += std::llround(u.position[a] * units * normal());
  }
  const double probe = u.repeatability * normal();
  c.settings.radius.coefficient[0] += thicker + probe;
  ProbeFeature f = feature;
  const Vec3 tilt(normal(), normal(), normal());
  f.normal = (f.normal + u.normal * (tilt - f.normal.dot(tilt) * f.normal)).normalized();
  return vec(c.correct(t, f, {}).workpiece) + u.tables * Vec3(normal(), normal(), normal());
}

TEST(ProbeUncertainty, AgreesWithAMonteCarlo) {
  ProbeCorrector corrector = probing_corrector();
  corrector.settings.radius.coefficient[0] = 1.4935e6;
  corrector.settings.workpiece.R = axis_rotation(Axis::y, 0.7);
  corrector.settings.uncertainty = example();
  const Touch touch = moving_touch();
  const ProbeFeature feature{1, Vec3(0.3, 0.5, -0.7).normalized()};
  const auto u = corrector.correct(touch, feature, {}).uncertainty;

  constexpr int kDraws = 100'000;
  Normal normal(32);
  const Vec3 centre = vec(corrector.correct(touch, feature, {}).workpiece);
  Vec3 sum = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 d = drawn(corrector, touch, feature, normal) - centre;
    sum += d;
    squares += d.cwiseProduct(d);
  }
  for (int k = 0; k < 3; ++k) {
    const double mean = sum[k] / kDraws;
    const double deviation = std::sqrt(squares[k] / kDraws - mean * mean);
    EXPECT_NEAR(deviation, static_cast<double>(u[static_cast<std::size_t>(k)]), 0.05 * deviation)
        << k;
  }
}

// Radius and arm come from one calibration (docs/papers/l300g.md). Before an end face both carry
// the ball away from it: errors in the same sense add up, in opposite senses they cancel.
TEST(ProbeUncertainty, RadiusAndArmKnowOfEachOther) {
  ProbeCorrector corrector = probing_corrector();
  corrector.settings.radius.coefficient[0] = 1.5e6;
  ProbeUncertainty& u = corrector.settings.uncertainty;
  u.radius = u.tool_length = 100.0;
  const auto degrees = [](double d) { return static_cast<std::int64_t>(d * kUnitsPerDegree); };
  const Touch level = touch_at({100'000'000, 230'000'000, degrees(-39.025), 0});
  const ProbeFeature end_face{1, Vec3(1.0, 0.0, 0.0)};  // the arm points to −X
  const auto along = [&](double correlation) {
    u.correlation = correlation;
    return corrector.correct(level, end_face, {}).uncertainty[0];
  };
  EXPECT_NEAR(along(0.0), std::sqrt(2.0) * 100.0, 0.1);
  EXPECT_NEAR(along(1.0), 200.0, 0.1);
  EXPECT_NEAR(along(-1.0), 0.0, 1.0);
}

// Radius and arm from one calibration, wrong by the same amount along the same line: the errors
// cancel, and rounding leaves 0 or nearly so, never the root of a negative number.
TEST(ProbeUncertainty, ErrorsThatCancelLeaveNone) {
  Random random(33);
  ProbeCorrector corrector = probing_corrector();
  corrector.settings.uncertainty.radius = corrector.settings.uncertainty.tool_length = 180.0;
  corrector.settings.uncertainty.correlation = 1.0;
  for (int i = 0; i < 500; ++i) {
    const Touch touch = touch_at(random_probing_pose(random));
    // The arm points to −X of the tool.
    NominalPoint nominal;
    const NominalChain chain(probing_machine());
    chain.at(corrector.contact_pose(touch), Vec3::Zero(), {}, nominal);
    const Vec3 along_arm = nominal.part_to_base.transpose() * -nominal.tool_to_base.col(0);
    const ProbePoint point = corrector.correct(touch, {1, along_arm}, {});
    for (const float u : point.uncertainty) {
      ASSERT_TRUE(std::isfinite(u)) << i;
      EXPECT_LT(u, 1e-4F);
    }
  }
}

}  // namespace
}  // namespace volcomp::test
