// What follows from a machine file, against ISO 230-1 and what a drawing of the machine shows.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/pose_offset.hpp"
#include "host_sim/host/machine/machine_facts.hpp"

namespace volcomp::host {
namespace {

using testing::ElementsAre;

TEST(MachineFacts, ErrorsHaveTheNamesOfTheStandard) {
  const MachineFile file = read_machine_file(bundled_machine("trunnion"));
  EXPECT_THAT(motion_errors('C'), ElementsAre("EXC", "EYC", "EZC", "EAC", "EBC", "ECC"));
  EXPECT_THAT(location_errors(file.chain.axis(file.axis_index('C'))),
              ElementsAre("EX0C", "EY0C", "EA0C", "EB0C"));
  EXPECT_THAT(location_errors(file.chain.axis(file.axis_index('A'))),
              ElementsAre("EY0A", "EZ0A", "EB0A", "EC0A"));
  EXPECT_THAT(location_errors(file.chain.axis(file.axis_index('X'))), ElementsAre("EB0X", "EC0X"));
}

// X, Y and Z at right angles, whatever the table does.
TEST(MachineFacts, ThreeSlidesHaveFullAuthority) {
  EXPECT_NEAR(least_authority(read_machine_file(bundled_machine("trunnion"))).value, 1.0, 1e-12);
  EXPECT_NEAR(least_authority(read_machine_file(bundled_machine("xyfz"))).value, 1.0, 1e-12);
}

// The arm of the L300G lifts the ball by the cosine of its angle from the horizontal, which its
// travel takes through 90 degrees.
TEST(MachineFacts, AnUprightArmHasNone) {
  const LeastAuthority least = least_authority(read_machine_file(bundled_machine("l300g")));
  const double upright = std::abs(least.at[2] + 39.025 * kPi / 180.0);
  EXPECT_NEAR(least.value, std::abs(std::cos(upright)), 1e-9);
  EXPECT_LT(least.value, 0.2);
}

// Where the table lies flat, its axis is that of the tool: C turns the part and not the tool in it.
TEST(MachineFacts, ATrunnionIsSingularWhereItsTableLiesFlat) {
  const MachineFile file = read_machine_file(bundled_machine("trunnion"));
  const LeastAuthority least = least_turning(file, rotary_axes(file.chain));
  EXPECT_NEAR(least.value, std::abs(std::sin(least.at[3])), 1e-9);
  EXPECT_LT(least.value, 0.1);
}

TEST(MachineFacts, AxesOfTheTrunnionTurnTheToolAgainstTheWork) {
  const MachineFile file = read_machine_file(bundled_machine("trunnion"));
  const double tilt = -0.7;
  const Pose q{0.0, 0.0, 0.0, tilt, 1.2};
  // NC coordinates count the tool: positive A turns it about +X against the work.
  EXPECT_LT((turning_column(file.chain, q, 3) - Vec3(1.0, 0.0, 0.0)).norm(), 1e-12);
  // The axis of C is tilted by the trunnion, which goes the other way.
  EXPECT_LT((turning_column(file.chain, q, 4) - Vec3(0.0, std::sin(tilt), std::cos(tilt))).norm(),
            1e-12);
}

}  // namespace
}  // namespace volcomp::host
