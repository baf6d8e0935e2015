// The offset of C: what it is, when it changes, and when it is none.

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "comp/strokes/helix_instances.hpp"
#include "tests/oracle/internal_gears.hpp"
#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {
namespace {

constexpr std::int32_t kFeed_nm_s = 13'400'000;  // nm/s
constexpr double kUnit = 2.0 * kPi / 4294967296.0;

class Offsets {
 public:
  Offsets() {
    state.feed_nm_per_s = kFeed_nm_s;
    state.fresh = state.homed = true;
    state.stroke = Direction::forward;
    StrokeOffsetSettings settings;
    settings.rate = 1'000'000;  // at once, unless a test sets another
    EXPECT_TRUE(unit->configure(settings).ok());
  }

  [[nodiscard]] StrokeTableSource source() const {
    return {forward, backward, slot, 0, 250'000, kFeed_nm_s};
  }

  void activate() {
    ASSERT_TRUE(unit->stage(source()).ok());
    ASSERT_TRUE(unit->activate().ok());
    turn_round();
  }

  // A tick at the end of a stroke.
  void turn_round() const {
    StrokeState end = state;
    end.in_face = false;
    end.stroke_end = true;
    unit->tick(end);
  }

  // Offset at a place, rad.
  double at(double z_mm, std::uint16_t of_slot = 0) {
    state.z_command = to_nm(z_mm);
    state.slot = of_slot;
    return kUnit * unit->tick(state);
  }

  std::vector<double> forward{1e-5, 2e-5, 4e-5};
  std::vector<double> backward{-1e-5, -1e-5, -1e-5};
  std::vector<double> slot{0.0, 3e-6};
  StrokeState state{};
  std::unique_ptr<GrinderOffsets> unit = std::make_unique<GrinderOffsets>();
};

TEST(StrokeOffsets, IsStrokeTablePlusSlotTable) {
  Offsets o;
  o.activate();
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit);
  EXPECT_NEAR(o.at(0.375), 3e-5, kUnit);
  EXPECT_NEAR(o.at(0.375, 1), 3.3e-5, kUnit);
  EXPECT_EQ(o.unit->status(), kValid);
  o.state.stroke = Direction::backward;
  EXPECT_NEAR(o.at(0.375), -1e-5, kUnit);
  o.state.stroke = Direction::unknown;
  EXPECT_NEAR(o.at(0.375), 1e-5, kUnit) << "the mean of both";
  EXPECT_EQ(o.unit->status(), kDirectionUnknown);
}

TEST(StrokeOffsets, NewTablesWaitForTheEndOfAStrokeOutsideTheFace) {
  Offsets o;
  o.activate();
  o.forward = {5e-5, 5e-5, 5e-5};
  ASSERT_TRUE(o.unit->stage(o.source()).ok());
  ASSERT_TRUE(o.unit->activate().ok());
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit);
  o.state.stroke_end = o.state.in_face = true;
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit) << "not within the face";
  EXPECT_EQ(o.unit->stage(o.source()).reason, Reason::hand_over_pending);
  o.state.in_face = false;
  EXPECT_NEAR(o.at(0.0), 5e-5, kUnit);
  EXPECT_FALSE(o.unit->pending());
  EXPECT_EQ(o.unit->activate().reason, Reason::not_staged);
}

TEST(StrokeOffsets, NeverJump) {
  Offsets o;
  StrokeOffsetSettings settings;
  settings.rate = 100;
  ASSERT_TRUE(o.unit->configure(settings).ok());
  o.activate();
  std::int32_t before = o.unit->tick(o.state);
  for (int k = 0; k < 2000; ++k) {
    if (k == 700) o.state.stroke = Direction::backward;
    if (k == 1400) o.unit->deactivate();
    const std::int32_t now = o.unit->tick(o.state);
    EXPECT_LE(std::abs(now - before), 100);
    before = now;
  }
  EXPECT_EQ(before, 0) << "deactivated";
  EXPECT_EQ(o.unit->status(), kNoTables);
}

TEST(StrokeOffsets, AnotherFeedOrNoReferenceMeansNone) {
  Offsets o;
  o.activate();
  for (const double feed : {0.981, 1.0, 1.019}) {
    o.state.feed_nm_per_s = static_cast<std::int32_t>(feed * kFeed_nm_s);
    EXPECT_NEAR(o.at(0.0), 1e-5, kUnit) << feed;
    EXPECT_TRUE(o.unit->feed_status().ok());
  }
  for (const double feed : {0.979, 1.021, 0.0}) {
    o.state.feed_nm_per_s = static_cast<std::int32_t>(feed * kFeed_nm_s);
    EXPECT_EQ(o.at(0.0), 0.0) << feed;
    const Status status = o.unit->feed_status();
    EXPECT_EQ(status.reason, Reason::feed_mismatch);
    EXPECT_NEAR(status.where.value, 13.4, 1e-9) << "what the table is for";
  }
  o.state.feed_nm_per_s = kFeed_nm_s;
  o.state.homed = false;
  EXPECT_EQ(o.at(0.0), 0.0);
  EXPECT_EQ(o.unit->status(), kNotHomed);
}

// Neither the step nor its change: strokes that turn round, frames that are missing, tables that
// go.
TEST(StrokeOffsets, NeverJumpNorBendWithAnAcceleration) {
  Offsets o;
  const OffsetLimits limits{kMostRounded, 2'000, 2'000, 50};
  StrokeOffsetSettings settings;
  settings.rate = limits.rate;
  settings.acceleration = limits.acceleration;
  ASSERT_TRUE(o.unit->configure(settings).ok());
  LimitedPromise promise(limits);
  promise.started(0);
  o.activate();
  int limited = 0;
  for (int k = 0; k < 4'000; ++k) {
    o.state.stroke = k / 150 % 2 == 0 ? Direction::forward : Direction::backward;
    o.state.fresh = k % 400 >= 30;
    o.state.z_command = to_nm(k % 150 * 0.005);
    if (k == 3'000) o.unit->deactivate();
    ASSERT_STREQ(promise.broken_by(o.unit->tick(o.state)), nullptr) << k;
    if ((o.unit->status() & kRateLimited) != 0) ++limited;
  }
  EXPECT_GT(limited, 100);
  EXPECT_EQ(promise.offset(), 0) << "deactivated";
}

TEST(StrokeOffsets, AnAccelerationThatIsNoneIsRefused) {
  Offsets o;
  StrokeOffsetSettings settings;
  settings.acceleration = -1;
  const Status refused = o.unit->configure(settings);
  EXPECT_EQ(refused.reason, Reason::bad_setting);
  EXPECT_STREQ(refused.where.field, "acceleration");
}

// Up to 20 ticks without a frame the offset stays, then it goes to 0 at the slew limit.
TEST(StrokeOffsets, HoldsThenDropsWithoutFrames) {
  Offsets o;
  o.activate();
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit);
  o.state.fresh = false;
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(o.at(0.5), 1e-5, kUnit);
    EXPECT_EQ(o.unit->status(), kStale);
  }
  EXPECT_EQ(o.at(0.5), 0.0);
  EXPECT_EQ(o.unit->status(), kStale | kDropped);
  EXPECT_EQ(o.unit->stale(), 21U);
  o.state.fresh = true;
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit);
}

TEST(StrokeOffsets, StandsAtTheEndOfItsTableAndSaysSo) {
  Offsets o;
  o.activate();
  EXPECT_NEAR(o.at(-3.0), 1e-5, kUnit);
  EXPECT_EQ(o.unit->status(), kOutOfRange);
  EXPECT_NEAR(o.at(9.0), 4e-5, kUnit);
  EXPECT_EQ(o.unit->out_of_table(), 2U);
  EXPECT_NEAR(o.at(0.5), 4e-5, kUnit);
  EXPECT_EQ(o.unit->status(), kValid);
  EXPECT_NEAR(o.at(0.5, 7), 4e-5, kUnit) << "a slot the table does not have";
  EXPECT_EQ(o.unit->out_of_table(), 3U) << "sticky";
  o.state.z_command = INT64_MIN;
  EXPECT_NEAR(kUnit * o.unit->tick(o.state), 1e-5 + 0.0, 4e-6);
}

TEST(StrokeOffsets, WithoutASlotTableEverySlotIsLikeTheOthers) {
  Offsets o;
  o.slot.clear();
  o.activate();
  EXPECT_NEAR(o.at(0.5, 7), 4e-5, kUnit);
  EXPECT_EQ(o.unit->status(), kValid);
}

TEST(StrokeOffsets, FeedsAreComparedForTablesInForceOnly) {
  Offsets o;
  EXPECT_TRUE(o.unit->feed_status().ok());
  o.activate();
  o.state.feed_nm_per_s = 2 * kFeed_nm_s;
  o.at(0.0);
  EXPECT_EQ(o.unit->feed_status().reason, Reason::feed_mismatch);
  EXPECT_NEAR(o.unit->feed_status().where.value, 13.4, 1e-9);
  o.unit->deactivate();
  o.at(0.0);
  EXPECT_TRUE(o.unit->feed_status().ok());
}

TEST(StrokeOffsetsRefusal, KeepsTheActiveTables) {
  Offsets o;
  o.activate();
  const auto refused = [&](const auto& change) {
    Offsets bad;
    StrokeTableSource s = bad.source();
    change(bad, s);
    return o.unit->stage(s);
  };
  EXPECT_EQ(refused([](auto&, auto& s) {
              s.forward = {s.forward.data(), 1};
            }).reason,
            Reason::too_few_knots);
  EXPECT_EQ(refused([](auto&, auto& s) {
              s.backward = {s.backward.data(), 2};
            }).reason,
            Reason::length_mismatch);
  EXPECT_EQ(refused([](auto&, auto& s) { s.pitch_nm = 0; }).reason, Reason::pitch_not_positive);
  EXPECT_EQ(refused([](auto&, auto& s) { s.pitch_nm = 2'000'000'000; }).reason,
            Reason::travel_too_long);
  EXPECT_STREQ(refused([](auto&, auto& s) { s.feed_nm_per_s = 0; }).where.field, "feed");
  const Status nan = refused([](auto& bad, auto&) { bad.backward[2] = std::nan(""); });
  EXPECT_EQ(nan.reason, Reason::not_finite);
  EXPECT_STREQ(nan.where.field, "backward");
  EXPECT_EQ(nan.where.index, 2);
  EXPECT_EQ(refused([](auto& bad, auto&) { bad.slot[1] = 4e-3; }).reason, Reason::bound_exceeded);
  EXPECT_EQ(o.unit->activate().reason, Reason::not_staged);
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit);
  std::vector<double> many(kStrokeNodes + 1, 0.0);
  EXPECT_EQ(o.unit->stage({many, many, {}, 0, 250'000, kFeed_nm_s}).reason, Reason::too_many_knots);
  const std::vector<double> teeth(kGearSlots + 1, 0.0);
  const Status slots = o.unit->stage({o.forward, o.backward, teeth, 0, 250'000, kFeed_nm_s});
  EXPECT_EQ(slots.reason, Reason::too_many_knots);
  EXPECT_STREQ(slots.where.field, "slot");
  const auto bad = [&](std::int32_t rate, std::uint32_t stale_ticks) {
    return o.unit->configure({rate, stale_ticks}).where.field;
  };
  EXPECT_STREQ(bad(0, 20), "rate");
  EXPECT_STREQ(bad(INT32_MAX, 20), "rate");
  EXPECT_STREQ(bad(1000, 0), "stale_ticks");
  EXPECT_NEAR(o.at(0.0), 1e-5, kUnit) << "settings that are refused forget no tables";
}

}  // namespace
}  // namespace volcomp::test
