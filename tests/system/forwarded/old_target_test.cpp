// A drive that goes to its old target when it is enabled, and a node that sends none: the status of
// the node keeps the controller from enabling it. A controller that does not heed it makes the axis
// jump; how far is measured, not promised (docs/drives.md).

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/system/bus_world.hpp"
#include "tests/system/forwarded/old_target.hpp"

namespace volcomp::sim {
namespace {

using Node = OldTarget::Node;

class EnablingWithoutTarget : public testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] static OldTarget way(Node node, bool careless) {
    OldTarget way;
    way.node = node;
    way.careless = careless;
    way.controlword_at_once = GetParam();
    return way;
  }
};

// Missing reports, and bit 15 of a node that is well but waits.
TEST_P(EnablingWithoutTarget, IsNotDoneByAControllerThatHeedsTheNode) {
  for (const Node node : {Node::dead, Node::waits}) {
    const AfterEnabling after = enable_with_old_target(way(node, false));
    EXPECT_FALSE(after.enabled);
    EXPECT_EQ(after.moved_mm, 0.0);
  }
}

TEST_P(EnablingWithoutTarget, IsDoneAndMovesNothingWhileTheNodeServes) {
  const AfterEnabling after = enable_with_old_target(way(Node::serves, false));
  EXPECT_TRUE(after.enabled);
  EXPECT_FALSE(after.faulted);
  EXPECT_LT(after.moved_mm, 0.2);  // its correction comes back
}

// Without a limit of its force the axis is 63 % of the way (a time constant of 2 ms) after the
// first period of 2 ms, at whose end 6065h is looked at; then it stops at once.
TEST_P(EnablingWithoutTarget, MakesTheAxisJumpBeforeTheFollowingErrorStopsIt) {
  for (const Node node : {Node::dead, Node::waits}) {
    const AfterEnabling after = enable_with_old_target(way(node, true));
    EXPECT_TRUE(after.faulted);
    EXPECT_NEAR(after.moved_mm, 0.632 * kMovedByHand_mm, 0.01 * kMovedByHand_mm);
  }
}

// 10 m/s² for 10 ms are 0.5 mm, for one period of 2 ms 0.02 mm.
TEST_P(EnablingWithoutTarget, JumpsLessWithAHeavyAxis) {
  OldTarget heavy = way(Node::dead, true);
  heavy.most_acceleration_mm_per_s2 = 10'000.0;
  const AfterEnabling at_once = enable_with_old_target(heavy);
  heavy.following_timeout_ms = 10;
  const AfterEnabling late = enable_with_old_target(heavy);
  EXPECT_TRUE(at_once.faulted);
  EXPECT_TRUE(late.faulted);
  EXPECT_LT(at_once.moved_mm, 0.2);
  EXPECT_GT(late.moved_mm, 0.5);
  EXPECT_LT(late.moved_mm, 1.5);
}

// It does not hear {6040h, 607Ah} as {6040h}: nothing moves, and its EMCY says why.
TEST(ForwardedDriveOfExactLength, IsNeverEnabledByAMappingThatIsTooShort) {
  DriveKind exact;
  exact.behaviour.exact_length = true;
  host::BusSettings settings = bus_machine_settings();
  for (host::BusAxis& axis : settings.axes)
    axis.way = node::Way::forwarded_target;
  ForwardedWorld world(1, settings, {exact, exact, exact}, {});
  EXPECT_FALSE(world.bring_up());
  for (std::size_t a = 0; a < kForwardedAxes; ++a) {
    EXPECT_EQ(world.drive(a).objects().controlword, 0U);
    EXPECT_EQ(world.drive(a).position_units(), kForwardedBegin_nm);
  }
  const std::vector<EmergencyRecord>& all = world.controller().emergencies();
  EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                          [](const EmergencyRecord& e) { return e.code == 0x8220; }));
}

INSTANTIATE_TEST_SUITE_P(OfTypes1And255, EnablingWithoutTarget, testing::Bool());

}  // namespace
}  // namespace volcomp::sim
