// The L300G: what errors of its axes do to a master gear (docs/papers/l300g.md).

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/machine/inverse.hpp"
#include "comp/metrology/gears/gear_deviations.hpp"
#include "comp/metrology/gears/gear_path.hpp"
#include "comp/metrology/gears/gear_tolerance.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/oracle/l300g_machine.hpp"
#include "tests/oracle/paper_gear.hpp"

namespace volcomp::test {
namespace {

constexpr double kBall = 1.4935;
constexpr SwingArm kArm{173.7135, -39.025 * kPi / 180.0};
constexpr L300gDatum kDatum{0.0, 168.8053};

MachineChain chain_of() {
  MachineChain chain;
  EXPECT_TRUE(MachineChain::build(l300g_machine(kArm, kDatum), chain).ok());
  return chain;
}

TEST(L300g, BallCentreFollowsTheArm) {
  const MachineChain chain = chain_of();
  for (const double theta : {-0.2, 0.0, 0.03, 0.4}) {
    const Pose q{12.0, 230.0, kArm.zero + theta, 0.0};
    const Vec3 p = ideal_points(chain, q, chain.tool_point()).work;
    EXPECT_NEAR(p.x(), 12.0 + arm_foreshortening(kArm, q[2]), 1e-12);
    EXPECT_NEAR(p.y(), 230.0 - kDatum.y, 1e-12);
    EXPECT_NEAR(p.z(), arm_height(kArm, q[2]), 1e-12);
  }
  // 0.785 mm at 16.49 mm and 3.07 mm at 32.5 mm.
  double B = 0.0;
  ASSERT_TRUE(arm_angle(kArm, 16.49, B).ok());
  EXPECT_NEAR(arm_foreshortening(kArm, B), 0.785, 0.0006);
  ASSERT_TRUE(arm_angle(kArm, 32.5, B).ok());
  EXPECT_NEAR(arm_foreshortening(kArm, B), 3.07, 0.005);
}

TEST(L300g, OffsetsOfTheArmAreThoseOfEveryMachine) {
  const MachineChain chain = chain_of();
  const Vec3 error(0.004, -0.003, 0.007);
  for (const double theta : {-1.2, -0.1, 0.0, 0.05, 1.0}) {
    const Pose q{10.0, 230.0, kArm.zero + theta, 0.3};
    ArmOffset arm;
    MotionOffset general;
    ASSERT_TRUE(arm_offset(kArm, q[2], error, arm).ok());
    ASSERT_TRUE(motion_offset(chain, q, chain.tool_point(), error, general).ok());
    EXPECT_NEAR(arm.X, general.offset[0], 1e-14);
    EXPECT_NEAR(arm.Y, general.offset[1], 1e-14);
    EXPECT_NEAR(arm.B, general.offset[2], 1e-16);
  }
  ArmOffset kept{1.0, 2.0, 3.0};
  EXPECT_EQ(arm_offset(kArm, kArm.zero + 1.5, error, kept).reason, Reason::no_z_authority);
  EXPECT_EQ(kept.X, 1.0);
}

// --- the master gear

// Own deviation of the gear, mm.
double own(double s, double x) {
  const double u = (s - 9.510) / 19.781;
  return 1e-3 * (3.4 * u + 2.2 * std::sin(3.0 * kPi * u) + 3.2 * x / 27.0 +
                 1.85 * std::sin(3.0 * kPi * (x - 1.5) / 27.0));
}

// Injection "P8": 4 µm and 0.004°.
ErrorSet p8() {
  constexpr double kShift = 0.004;
  constexpr double kTurn = 0.004 * kPi / 180.0;
  const double sign[4][6] = {
      {1, -1, 1, -1, 1, 1}, {1, -1, -1, 1, 1, 1}, {1, -1, 1, 1, -1, 1}, {1, 1, 1, 1, 0, 0}};
  ErrorSet errors = zero_errors();
  for (std::size_t a = 0; a < 4; ++a) {
    for (int i = 0; i < 6; ++i)
      errors[a](i) = sign[a][i] * (i < 3 ? kShift : kTurn);
  }
  errors[3](4) = errors[3](5) = 0.0;
  return errors;
}

// Error motions by where the axes stand.
using ErrorsAt = std::function<ErrorSet(const Pose&)>;
ErrorsAt everywhere(const ErrorSet& errors) {
  return [errors](const Pose&) { return errors; };
}

enum class Trace { profile, lead };

// Centre of the ball in the frame of the gear.
Vec3 ball_centre(const MachineChain& chain, const Pose& q, const ErrorSet& errors) {
  const PointPair points = ideal_points(chain, q, chain.tool_point());
  return points.work +
         exact_error(chain, q, errors, Vec3::Zero(), RotationModel::rxryrz, points).position_work;
}

FlankDistance distance_of(const InvoluteGear& gear, FlankSide side, const Vec3& centre) {
  FlankDistance d;
  EXPECT_TRUE(distance_from_flank(gear, {side, 0}, {centre.y(), centre.z()}, 0.0, d).ok());
  return d;
}

// Swings B until the real ball touches the real flank.
void touch(const MachineChain& chain, const InvoluteGear& gear, FlankSide side,
           const ErrorsAt& errors, Pose& q) {
  for (int i = 0; i < 20; ++i) {
    const Vec3 centre = ball_centre(chain, q, errors(q));
    const FlankDistance d = distance_of(gear, side, centre);
    const double gap = d.distance - kBall - own(d.roll_length, centre.x());
    const Vec3 lift = jacobian_column(chain, q, chain.tool_point(), 2);
    const double c = std::cos(q[3]);  // base to gear: turned back by A about X
    const double s = std::sin(q[3]);
    const double along =
        d.normal.y * (c * lift.y() + s * lift.z()) + d.normal.z * (c * lift.z() - s * lift.y());
    q[2] -= gap / along;
  }
}

// Touches a flank, also a little beyond its range, and evaluates it from the encoders and the
// `known` errors.
TraceDeviations measure(Trace kind, FlankSide side, PathStyle style, const ErrorsAt& errors,
                        const ErrorsAt& known = everywhere(zero_errors())) {
  const MachineChain chain = chain_of();
  const InvoluteGear gear = gear_of_the_paper();
  const bool profile = kind == Trace::profile;
  const double used = 0.92 * (gear.roll_end - gear.roll_begin);
  const EvaluationRange range = profile ? EvaluationRange{gear.roll_begin, gear.roll_begin + used}
                                        : EvaluationRange{1.5, 28.5};
  const double pitch_roll = gear.r * std::sin(gear.pressure_angle);
  std::vector<double> at;
  std::vector<double> f;
  for (int i = -5; i <= 105; ++i) {
    const double u = range.low + (range.high - range.low) * i / 100.0;
    const FlankTouch wanted{{side, 0}, profile ? u : pitch_roll, profile ? 0.0 : u};
    Pose q{};
    EXPECT_TRUE(touch_pose(kArm, kDatum, gear, style, wanted, kBall, q).ok());
    touch(chain, gear, side, errors, q);
    const Vec3 centre = ball_centre(chain, q, known(q));
    const FlankDistance d = distance_of(gear, side, centre);
    at.push_back(profile ? d.roll_length : centre.x());
    f.push_back(deviation_of(gear, d.distance, kBall));
  }
  TraceDeviations d;
  EXPECT_TRUE(evaluate_trace(at, f, range, d).ok());
  return d;
}

double um(double mm) { return 1000.0 * mm; }

struct Wanted {
  double total_left, total_right;
  int grade;
};

void expect_total(Trace kind, PathStyle style, const ErrorSet& errors, const Wanted& wanted) {
  constexpr GearSize kSize{124.0, 4.0, 30.0};
  const GearDeviation deviation =
      kind == Trace::profile ? GearDeviation::profile : GearDeviation::lead;
  for (const FlankSide side : {FlankSide::left, FlankSide::right}) {
    const double total = um(measure(kind, side, style, everywhere(errors)).total);
    EXPECT_NEAR(total, side == FlankSide::left ? wanted.total_left : wanted.total_right, 0.2);
    EXPECT_EQ(grade_of(GearStandard::iso1328_1995, kSize, deviation, total), wanted.grade);
  }
}

TEST(L300g, AGoodMachineFindsTheGearAsItIs) {
  expect_total(Trace::profile, PathStyle::fixed_a, zero_errors(), {5.59, 5.59, 4});
  expect_total(Trace::lead, PathStyle::fixed_a, zero_errors(), {4.82, 4.82, 4});
  const TraceDeviations d =
      measure(Trace::profile, FlankSide::left, PathStyle::fixed_a, everywhere(zero_errors()));
  EXPECT_NEAR(um(d.form), 4.40, 0.2);
  EXPECT_NEAR(um(d.slope), 3.40, 0.2);
}

TEST(L300g, P8SpoilsTheProfileAndNotTheLead) {
  expect_total(Trace::profile, PathStyle::fixed_a, p8(), {20.57, 20.87, 8});
  expect_total(Trace::lead, PathStyle::fixed_a, p8(), {4.82, 4.82, 4});
}

TEST(L300g, GeneratingPathSeesLittleOfP8) {
  expect_total(Trace::profile, PathStyle::generate, p8(), {6.89, 7.11, 5});
}

// --- P8 and waves in all of the 24

// 0.4 µm and 7 µrad, periods X 90 mm, Y 60 mm, B 10°, A 40°; phases by `seed`.
ErrorsAt varied_p8(std::uint64_t seed) {
  constexpr double kDegree = kPi / 180.0;
  constexpr std::array<double, 4> kPeriod{90.0, 60.0, 10.0 * kDegree, 40.0 * kDegree};
  std::mt19937_64 bits(seed);
  std::array<std::array<double, 6>, 4> phase{};
  for (auto& axis : phase) {
    for (double& p : axis)
      p = 2.0 * kPi * static_cast<double>(bits() >> 11U) / 9007199254740992.0;
  }
  return [phase, kPeriod](const Pose& q) {
    ErrorSet errors = p8();
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t c = 0; c < 6; ++c)
        errors[a](static_cast<Eigen::Index>(c)) +=
            (c < 3 ? 0.4e-3 : 7e-6) * std::sin(2.0 * kPi * q[a] / kPeriod[a] + phase[a][c]);
    }
    return errors;
  };
}

// F over many machines, µm.
class Totals {
 public:
  Totals(Trace kind, FlankSide side) : kind_(kind), side_(side) {}
  void add(const ErrorsAt& errors, const ErrorsAt& known) {
    const double total = um(measure(kind_, side_, PathStyle::fixed_a, errors, known).total);
    least_ = std::min(least_, total);
    most_ = std::max(most_, total);
  }
  void expect_among_them(double um) const {
    EXPECT_GT(um, least_);
    EXPECT_LT(um, most_);
  }
  void expect_all_near(double um, double tolerance) const {
    EXPECT_NEAR(least_, um, tolerance);
    EXPECT_NEAR(most_, um, tolerance);
  }

 private:
  Trace kind_;
  FlankSide side_;
  double least_ = 1e9;
  double most_ = 0.0;
};

constexpr std::uint64_t kMachines = 32;
const ErrorsAt kNothing = everywhere(zero_errors());

// Each expected figure is that of one machine with unknown phases: ±1.5 µm between machines.
TEST(L300g, WavesBesideP8) {
  Totals raw_left(Trace::profile, FlankSide::left);
  Totals raw_right(Trace::profile, FlankSide::right);
  Totals lead_left(Trace::lead, FlankSide::left);
  Totals lead_right(Trace::lead, FlankSide::right);
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    for (Totals* totals : {&raw_left, &raw_right, &lead_left, &lead_right})
      totals->add(varied_p8(seed), kNothing);
  }
  raw_left.expect_among_them(20.55);
  raw_right.expect_among_them(21.07);
  lead_left.expect_among_them(4.88);
  lead_right.expect_among_them(5.79);
}

// Known functions find the gear on every such machine; the means, which the paper takes, leave the
// waves.
TEST(L300g, FunctionsTakeWavesAwayAndMeansDoNot) {
  Totals exact_left(Trace::profile, FlankSide::left);
  Totals exact_right(Trace::profile, FlankSide::right);
  Totals means_left(Trace::profile, FlankSide::left);
  Totals means_right(Trace::profile, FlankSide::right);
  Totals lead_left(Trace::lead, FlankSide::left);
  Totals lead_right(Trace::lead, FlankSide::right);
  const ErrorsAt means = everywhere(p8());
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    const ErrorsAt errors = varied_p8(seed);
    for (Totals* totals : {&exact_left, &exact_right})
      totals->add(errors, errors);
    for (Totals* totals : {&means_left, &means_right, &lead_left, &lead_right})
      totals->add(errors, means);
  }
  exact_left.expect_all_near(5.61, 0.2);
  exact_right.expect_all_near(5.58, 0.2);
  means_left.expect_among_them(5.50);
  means_right.expect_among_them(5.55);
  lead_left.expect_among_them(4.90);
  lead_right.expect_among_them(5.49);
}

}  // namespace
}  // namespace volcomp::test
