// Touches that are meant for a flank of a face gear: the gear and the flank are written before, the
// judgement comes with the point.

#include <limits>
#include <string>

#include "comp/core/units.hpp"
#include "comp/probe/face_flank.hpp"
#include "tests/firmware/node/probe/probe_bench.hpp"

namespace volcomp::node {
namespace {

constexpr std::uint32_t kGearId = 7;
constexpr std::uint32_t kRadius_nm = 500'000;
constexpr std::uint32_t kGate_nm = 100'000;
constexpr int kSlot = 11;

class FlankTouch : public NodeProbe {
 protected:
  AbortCode number(std::uint8_t sub, double value) { return set_real(0x2312, sub, value); }
  AbortCode load(std::uint32_t id) { return bench.set<std::uint32_t>(0x2311, 1, id); }
  // The gear of Table 3.
  void send_gear() {
    const std::array<double, 11> numbers{25,    86,   4.0, gear.pressure_angle, 0, 0, 0, 0,
                                         0.060, 48.4, 2.4};
    for (std::size_t i = 0; i < numbers.size(); ++i)
      ASSERT_EQ(number(static_cast<std::uint8_t>(i + 1), numbers[i]), AbortCode::none);
    ASSERT_EQ(load(kGearId), AbortCode::none);
  }
  void stage(int side = 1, std::uint32_t radius_nm = kRadius_nm) {
    ASSERT_EQ(bench.set<std::uint32_t>(0x2313, 1, kGearId), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint8_t>(0x2313, 2, static_cast<std::uint8_t>(side)), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint16_t>(0x2313, 3, kSlot), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint8_t>(0x2313, 4, 3), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint8_t>(0x2313, 5, 9), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint32_t>(0x2313, 6, radius_nm), AbortCode::none);
    ASSERT_EQ(bench.set<std::uint32_t>(0x2313, 7, kGate_nm), AbortCode::none);
  }
  AbortCode announce() { return bench.set<std::uint32_t>(0x2310, 1, ++feature); }

  void ready() {
    start();
    send_gear();
    edge(0);
    centre = take().workpiece;
  }
  // A touch with the ball at `wanted`, mm in the gear frame: the gear is put where it has to be.
  ReadPoint touch_at(const Vec3& wanted) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = static_cast<double>(centre[k]) - kNmPerMm * wanted[static_cast<int>(k)];
      EXPECT_EQ(set_real(0x2303, static_cast<std::uint8_t>(10 + k), t), AbortCode::none);
    }
    EXPECT_EQ(switch_on(), AbortCode::none);
    bench.cycles(3);
    edge(0);
    return take();
  }
  // The result of the kernel for the point itself.
  [[nodiscard]] FaceTouch judged(const ReadPoint& point, int side = 1, double radius = 0.5) const {
    FaceFlank flank;
    EXPECT_TRUE(choose_flank(gear, side, kSlot, flank).ok());
    Vec3 q;
    for (int k = 0; k < 3; ++k)
      q[k] = static_cast<double>(point.workpiece[static_cast<std::size_t>(k)]) / kNmPerMm;
    return judge_touch(gear, flank, {radius, 0.1}, q);
  }
  // So far off the flank of side 1, in the middle of it.
  [[nodiscard]] Vec3 off(double mm, const FaceParameters& at = {0.6, 0.42}) const {
    FaceFlank flank;
    EXPECT_TRUE(choose_flank(gear, 1, kSlot, flank).ok());
    const FacePoint on = relieved_face_point(gear, flank, at);
    return on.point + mm * on.normal;
  }

  FaceGear gear = face_gear_of_table_3();
  std::array<std::int64_t, 3> centre{};
  std::uint32_t feature = 40;
};

TEST_F(FlankTouch, CarriesDistanceFootAndVerdictOfTheKernel) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  const ReadPoint point = touch_at(off(0.51));
  const FaceTouch expected = judged(point);
  ASSERT_EQ(expected.verdict, Reason::ok) << code(expected.foot.reason);
  EXPECT_EQ(point.verdict, TouchVerdict::centre);
  EXPECT_EQ(point.feature, feature);
  EXPECT_EQ(point.side, 1);
  EXPECT_EQ(point.slot, kSlot);
  EXPECT_EQ(point.row, 3U);
  EXPECT_EQ(point.column, 9U);
  EXPECT_EQ(point.flank_verdict, static_cast<std::uint8_t>(Reason::ok));
  EXPECT_EQ(point.foot_verdict, static_cast<std::uint8_t>(Reason::ok));
  EXPECT_EQ(std::memcmp(&point.distance, &expected.distance, sizeof(double)), 0) << "every bit";
  EXPECT_EQ(std::memcmp(point.foot.data(), expected.foot.point.data(), 3 * sizeof(double)), 0);
  EXPECT_EQ(static_cast<std::int32_t>(bench.number(0x2401, 12)), distance_nm(expected.distance));
  EXPECT_EQ(bench.number(0x2401, 13), 0U);
  EXPECT_EQ(bench.number(0x2401, 14), 0U);
  EXPECT_EQ(bench.number(0x2401, 15), point.sequence);
}

TEST_F(FlankTouch, EveryVerdictComesFromTheKernel) {
  ready();
  struct Case {
    double off_mm;
    int side;
    std::uint32_t radius_nm;
    Reason verdict;
  };
  // The slot is 6 to 7 mm wide there.
  for (const Case& c :
       {Case{0.5, 1, kRadius_nm, Reason::ok}, Case{0.5, -1, kRadius_nm, Reason::opposite_flank},
        Case{0.1, 1, kRadius_nm, Reason::ball_in_metal},
        Case{1.0, 1, kRadius_nm, Reason::nothing_touched}}) {
    stage(c.side, c.radius_nm);
    ASSERT_EQ(announce(), AbortCode::none);
    const ReadPoint point = touch_at(off(c.off_mm));
    EXPECT_EQ(point.flank_verdict, static_cast<std::uint8_t>(c.verdict)) << c.off_mm;
    EXPECT_EQ(judged(point, c.side).verdict, c.verdict) << c.off_mm;
  }
}

TEST_F(FlankTouch, ABallThatFillsTheSlotTouchesBothFlanks) {
  ready();
  Vec3 middle = off(0.5);
  const double radius = middle.head<2>().norm();
  const double angle = 2.0 * kPi * kSlot / gear.teeth;
  middle[0] = radius * std::cos(angle);
  middle[1] = radius * std::sin(angle);
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  const double half_width = judged(touch_at(middle)).distance;
  stage(1, static_cast<std::uint32_t>(half_width * kNmPerMm));
  ASSERT_EQ(announce(), AbortCode::none);
  EXPECT_EQ(touch_at(middle).flank_verdict, static_cast<std::uint8_t>(Reason::two_flanks));
}

TEST_F(FlankTouch, WithoutADistanceThePointIsBad) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  const ReadPoint point = touch_at({10.0, 0.0, 47.0});
  EXPECT_EQ(point.flank_verdict, static_cast<std::uint8_t>(Reason::bad_point));
  EXPECT_EQ(point.foot_verdict, static_cast<std::uint8_t>(Reason::inside_gear_base));
  EXPECT_NE(point.distance, point.distance) << "NaN";
  EXPECT_EQ(static_cast<std::int32_t>(bench.number(0x2401, 12)), kNoDistance);
}

TEST_F(FlankTouch, TheRecordIsTakenOverWithTheIndexAndNotBefore) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  stage(-1);
  const ReadPoint point = touch_at(off(0.5));
  EXPECT_EQ(point.side, 1);
  EXPECT_EQ(point.flank_verdict, static_cast<std::uint8_t>(Reason::ok));
  ASSERT_EQ(bench.set<std::uint32_t>(0x2313, 1, 0), AbortCode::none);
  ASSERT_EQ(announce(), AbortCode::none);
  const ReadPoint plain = touch_at(off(0.5));
  EXPECT_EQ(plain.flank_verdict, kNotJudged);
  EXPECT_EQ(plain.side, 0);
  EXPECT_EQ(bench.number(0x2401, 15), point.sequence) << "the judgement of the one before";
}

TEST_F(FlankTouch, ARejectedTouchIsNotJudged) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  bench.drive[0].status = 0x0027;
  const ReadPoint point = touch_at(off(0.5));
  EXPECT_EQ(point.verdict, TouchVerdict::not_homed);
  EXPECT_EQ(point.flank_verdict, kNotJudged);
  EXPECT_EQ(bench.number(0x2401, 13), kNotJudged);
}

TEST_F(FlankTouch, ABadRecordIsRefusedAndTheOldOneStays) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  struct Bad {
    std::uint8_t sub, size;
    std::uint32_t value;
    Reason reason;
  };
  for (const Bad& bad : {Bad{1, 4, kGearId + 1, Reason::bad_gear}, Bad{2, 1, 0, Reason::bad_point},
                         Bad{2, 1, 2, Reason::bad_point}, Bad{3, 2, 86, Reason::bad_point},
                         Bad{6, 4, 0, Reason::bad_point}, Bad{6, 4, 20'000'001, Reason::bad_point},
                         Bad{7, 4, 0, Reason::bad_point}}) {
    stage();
    Bytes bytes(bad.size);
    store_le(bytes.data(), bytes.size(), bad.value);
    ASSERT_EQ(bench.write({0x2313, bad.sub}, bytes), AbortCode::none);
    EXPECT_EQ(announce(), AbortCode::invalid_value) << +bad.sub;
    EXPECT_EQ(bench.number(0x2310, 5), static_cast<std::uint64_t>(bad.reason));
    EXPECT_EQ(bench.number(0x2310, 6), bad.sub);
  }
  EXPECT_EQ(touch_at(off(0.5)).flank_verdict, static_cast<std::uint8_t>(Reason::ok));
  stage();
  EXPECT_EQ(announce(), AbortCode::none);
  EXPECT_EQ(bench.number(0x2310, 5), 0U);
  EXPECT_EQ(bench.number(0x2310, 6), 0U);
}

TEST_F(FlankTouch, NumbersThatMakeNoGearAreRefusedByName) {
  ready();
  struct Bad {
    std::uint8_t sub;
    double value, good;
    const char* field;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Bad& bad :
       {Bad{1, 4, 25, "shaper_teeth"}, Bad{1, 25.5, 25, "shaper_teeth"}, Bad{2, 300, 86, "teeth"},
        Bad{2, nan, 86, "teeth"}, Bad{3, nan, 4.0, "module"},
        Bad{4, 1.0, gear.pressure_angle, "pressure_angle"}, Bad{6, 3.0, 0.0, "shaper_addendum"},
        Bad{7, 10.0, 0.0, "r_in"}, Bad{8, 500.0, 0.0, "r_out"},
        Bad{9, 2.0, 0.060, "relief.amount"}}) {
    ASSERT_EQ(number(bad.sub, bad.value), AbortCode::none);
    EXPECT_EQ(load(8), AbortCode::invalid_value) << bad.field;
    EXPECT_EQ(bench.number(0x2311, 1), kGearId) << "the old one stays";
    EXPECT_EQ(bench.number(0x2311, 2), static_cast<std::uint64_t>(Reason::bad_gear));
    EXPECT_EQ(bench.text(0x2311, 3), bad.field);
    ASSERT_EQ(number(bad.sub, bad.good), AbortCode::none);
  }
  EXPECT_EQ(load(8), AbortCode::none);
  EXPECT_EQ(bench.number(0x2311, 2), 0U);
  EXPECT_EQ(bench.text(0x2311, 3), "");
}

TEST_F(FlankTouch, AnotherGearEndsTheAnnouncedFlank) {
  ready();
  stage();
  ASSERT_EQ(announce(), AbortCode::none);
  ASSERT_EQ(load(8), AbortCode::none);
  EXPECT_EQ(touch_at(off(0.5)).flank_verdict, kNotJudged);
  EXPECT_EQ(announce(), AbortCode::invalid_value) << "2313h names the old gear";
  ASSERT_EQ(load(0), AbortCode::none);
  EXPECT_EQ(announce(), AbortCode::invalid_value);
}

TEST(FlankDistance, IsRoundedToNanometres) {
  EXPECT_EQ(distance_nm(0.5), 500'000);
  EXPECT_EQ(distance_nm(-1.6e-6), -2);
  EXPECT_EQ(distance_nm(3000.0), kNoDistance);
  EXPECT_EQ(distance_nm(std::numeric_limits<double>::quiet_NaN()), kNoDistance);
}

}  // namespace
}  // namespace volcomp::node
