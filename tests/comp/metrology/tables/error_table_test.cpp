// The six-channel table: lookup, checks, resampling, and its quantised form.

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "comp/metrology/tables/volumetric_model.hpp"
#include "comp/tables/image.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

constexpr double kTurn = 2.0 * kPi;

std::unique_ptr<ErrorTable> make_table(double q0, double pitch, std::size_t knots) {
  auto t = std::make_unique<ErrorTable>();
  t->q0 = q0;
  t->pitch = pitch;
  t->knots = knots;
  for (std::size_t i = 0; i < kTableKnots; ++i)
    t->forward[i] = t->backward[i] = ErrorMotion::Zero();
  return t;
}

// Channel c at knot i: a number that encodes where it came from.
double mark(std::size_t i, Eigen::Index c) {
  return 1e-4 * static_cast<double>(i) + 1e-2 * static_cast<double>(c);
}

Joint joint_of(JointKind kind) {
  Joint joint;
  joint.kind = kind;
  joint.letter = kind == JointKind::rotary ? 'C' : 'X';
  return joint;
}

TEST(ErrorTable, InterpolatesEveryChannelLinearlyAndHoldsTheEnds) {
  auto t = make_table(-300.0, 30.0, 11);
  for (std::size_t i = 0; i < 11; ++i) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      t->forward[i](c) = mark(i, c);
      t->backward[i](c) = mark(i, c) + 1.0;
    }
  }
  for (Eigen::Index c = 0; c < 6; ++c) {
    const double at = mark(3, c) + 0.25e-4;  // a quarter of the way from knot 3 to 4
    EXPECT_NEAR(t->linear(-202.5, Travel::forward)(c), at, 1e-15);
    EXPECT_NEAR(t->linear(-202.5, Travel::backward)(c), at + 1.0, 1e-15);
    EXPECT_NEAR(t->linear(-202.5, Travel::unknown)(c), at + 0.5, 1e-15);
    EXPECT_EQ(t->linear(-1e9, Travel::forward)(c), mark(0, c));
    EXPECT_NEAR(t->linear(1e9, Travel::forward)(c), mark(10, c), 1e-16);
    EXPECT_NEAR(t->linear(0.0, Travel::forward)(c), mark(10, c), 1e-16);
  }
}

TEST(ErrorTable, RefusalsNameKnotAndChannel) {
  auto t = make_table(0.0, 10.0, 11);
  EXPECT_TRUE(check_table(*t, 'X', 11).ok());
  EXPECT_EQ(check_table(*t, 'X', 10).reason, Reason::too_many_knots);
  EXPECT_EQ(check_table(*t, 'X', 10).where.count, 11);
  t->knots = 1;
  EXPECT_EQ(check_table(*t, 'X', 11).reason, Reason::too_few_knots);
  t->knots = kTableKnots + 1;
  EXPECT_EQ(check_table(*t, 'X', 100000).reason, Reason::too_many_knots);
  t->knots = 11;
  for (const double pitch : {0.0, -1.0, 1e-320, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    t->pitch = pitch;
    EXPECT_EQ(check_table(*t, 'X', 11).reason, Reason::pitch_not_positive) << pitch;
  }
  t->pitch = 10.0;
  t->backward[7](4) = std::numeric_limits<double>::quiet_NaN();
  const Status status = check_table(*t, 'X', 11);
  EXPECT_EQ(status.reason, Reason::not_finite);
  EXPECT_EQ(status.where.axis, 'X');
  EXPECT_EQ(status.where.index, 7);
  EXPECT_EQ(status.where.channel, 4);
  t->backward[7](4) = 0.0;
  t->q0 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(check_table(*t, 'X', 11).reason, Reason::not_finite);
}

TEST(ErrorTable, RefiningKeepsTheKnotsTheTravelAndBothDirections) {
  Random random;
  auto t = make_table(-400.0, 40.0, 11);
  for (std::size_t i = 0; i < 11; ++i) {
    t->forward[i] = random.error(0.02, 1e-4);
    t->backward[i] = random.error(0.02, 1e-4);
  }
  auto fine = make_table(0, 0, 0);
  for (const Interpolation kind :
       {Interpolation::linear, Interpolation::catmull_rom, Interpolation::pchip}) {
    ASSERT_TRUE(refine(*t, kind, 8, *fine).ok());
    ASSERT_EQ(fine->knots, 81U);
    EXPECT_EQ(fine->pitch, 5.0);
    for (std::size_t i = 0; i < 11; ++i) {
      EXPECT_LE((fine->forward[8 * i] - t->forward[i]).norm(), 1e-16);
      EXPECT_LE((fine->backward[8 * i] - t->backward[i]).norm(), 1e-16);
    }
  }
  EXPECT_EQ(refine(*t, Interpolation::pchip, 0, *fine).reason, Reason::too_few_knots);
  EXPECT_EQ(refine(*t, Interpolation::pchip, 52, *fine).reason, Reason::too_many_knots);
  EXPECT_EQ(fine->knots, 81U) << "written on refusal";
}

TEST(Quantise, LinearTableReturnsWithinFloatAndNanometre) {
  Random random;
  auto t = make_table(-499.9999996, 49.99999996, 11);
  for (std::size_t i = 0; i < 11; ++i) {
    t->forward[i] = random.error(0.05, 1e-4);
    t->backward[i] = random.error(0.05, 1e-4);
  }
  AxisTable q;
  ASSERT_TRUE(quantise(*t, joint_of(JointKind::prismatic), kTableKnots, q).ok());
  EXPECT_EQ(q.q0, -500'000'000);
  EXPECT_EQ(q.pitch, 50'000'000);
  EXPECT_FALSE(q.periodic);
  auto back = make_table(0, 0, 0);
  dequantise(q, joint_of(JointKind::prismatic), *back);
  for (std::size_t i = 0; i < 11; ++i) {
    const ErrorMotion d = back->forward[i] - t->forward[i];
    EXPECT_LE(translation(d).cwiseAbs().maxCoeff(), 0.05 * 6e-8 + 1e-8);
    EXPECT_LE(rotation(d).cwiseAbs().maxCoeff(), 1e-4 * 6e-8 + 1e-11);
  }
}

TEST(Quantise, RefusesTravelTheLookupCannotHold) {
  AxisTable q;
  auto t = make_table(0.0, 429.0, 11);  // 4.290 m
  EXPECT_TRUE(quantise(*t, joint_of(JointKind::prismatic), kTableKnots, q).ok());
  t->pitch = 430.0;  // 4.300 m ≥ 2^32 nm
  EXPECT_EQ(quantise(*t, joint_of(JointKind::prismatic), kTableKnots, q).reason,
            Reason::travel_too_long);
  t->pitch = 1e-8;
  EXPECT_EQ(quantise(*t, joint_of(JointKind::prismatic), kTableKnots, q).reason,
            Reason::pitch_not_positive);
}

// A rotary table over more than one turn cannot be looked up either: positions count through, the
// lookup has 32 bits per turn.
TEST(Quantise, RefusesRotaryTablesBeyondOneTurn) {
  AxisTable q;
  auto t = make_table(0.0, kTurn / 5.0, 11);  // two turns
  EXPECT_EQ(quantise(*t, joint_of(JointKind::rotary), kTableKnots, q).reason,
            Reason::travel_too_long);
}

// Conventions, section 5: "files repeat [the last knot], first = last checked". Per direction: a
// seam of +5 µm forward and −5 µm backward is a step in both.
TEST(Quantise, RefusesASeamInEitherDirection) {
  AxisTable q;
  auto t = make_table(0.0, kTurn / 12.0, 13);
  EXPECT_TRUE(quantise(*t, joint_of(JointKind::rotary), kTableKnots, q).ok());
  EXPECT_TRUE(q.periodic);
  EXPECT_EQ(q.knots, 12U);
  t->forward[12](0) = 0.005;
  EXPECT_EQ(quantise(*t, joint_of(JointKind::rotary), kTableKnots, q).reason, Reason::not_periodic);
  t->backward[12](0) = -0.005;
  EXPECT_EQ(quantise(*t, joint_of(JointKind::rotary), kTableKnots, q).reason, Reason::not_periodic);
}

// A turn divided by any number of knots survives storing: 2^40 is divisible by few of them.
TEST(Quantise, FullTurnTablesOfAnyKnotCountSurviveTheImage) {
  auto tables = std::make_unique<MachineTables>();
  auto loaded = std::make_unique<MachineTables>();
  tables->machine.body_count = 2;
  tables->machine.body[1].lower = 1;
  tables->machine.body[1].joint = joint_of(JointKind::rotary);
  tables->machine.work_body = 1;
  tables->machine.tool_body = 2;
  tables->directions = zero_directions();
  for (std::size_t n = 2; n <= 128; ++n) {
    const auto t = make_table(0.0, kTurn / static_cast<double>(n), n + 1);
    ASSERT_TRUE(quantise(*t, tables->machine.body[1].joint, kTableKnots, tables->axis[0]).ok());
    std::vector<std::uint8_t> image(image_size(*tables));
    std::size_t written = 0;
    ASSERT_TRUE(encode_image(*tables, image, written).ok());
    const Status status = decode_image(image, 128, *loaded);
    EXPECT_TRUE(status.ok()) << n << " knots per turn: " << code(status.reason);
  }
}

// The double model stands for the tick, and the tick wraps: a turn more changes nothing.
TEST(VolumetricModel, FullTurnTableWraps) {
  auto t = make_table(0.0, kTurn / 36.0, 37);
  for (std::size_t i = 0; i < 37; ++i) {
    const double a = t->knot(i);
    t->forward[i] << 0.004 * std::sin(a), 0.003 * std::cos(a), 0, 1e-5 * std::cos(2 * a), 0, 0;
    t->backward[i] = t->forward[i];
  }
  VolumetricModel model;
  MachineDescription m;
  m.body_count = 2;
  m.body[1].lower = 1;
  m.body[1].joint = joint_of(JointKind::rotary);
  m.body[1].joint.axis = Axis::z;
  m.work_body = 1;
  m.tool_body = 2;
  model.chain = chain_of(m);
  model.table[0] = t.get();
  model.tool_point = Vec3(100, 20, 300);
  for (const Beyond beyond : {Beyond::lever_as_given, Beyond::stand_at_end}) {
    for (const double angle : {0.4, 3.0, 6.0}) {
      const Vec3 want = model.second_order({angle}, kUnknownTravels, beyond);
      for (const double turns : {-2.0, -1.0, 1.0, 5.0}) {
        const Vec3 got = model.second_order({angle + turns * kTurn}, kUnknownTravels, beyond);
        EXPECT_LE((got - want).norm(), 1e-12) << angle << " + " << turns << " turns";
      }
    }
  }
}

}  // namespace
}  // namespace volcomp::test
