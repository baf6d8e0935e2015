#pragma once
// The test of rotary axes with a ball on the table (ISO 10791-6, BK; the R-test): the rotary axes
// turn, the other axes follow so that the tool stays at the centre of the ball, and what it is off
// is read.

#include <vector>

#include "host_sim/experiments/any_machine/places.hpp"

namespace volcomp::any_machine {

struct SpherePlan {
  Vec3 ball = Vec3::Zero();  // centre, work frame, mm
  std::vector<Pose> poses;   // the first with the rotary axes at their references
  std::size_t left_out = 0;  // positions of the rotary axes that the other axes cannot follow to
};

// Twelve positions of an axis that turns all round, five of any other; the ball where most of them
// can be reached, then where the other axes travel farthest. Without poses where no rotary axis is
// left to turn or fewer than three axes follow: linear ones, else the correcting ones.
[[nodiscard]] SpherePlan plan_sphere_test(const host::MachineFile& file);

// Pose whose ideal tool point is at `ball` with all axes but `following` as in `q`; false where
// there is none within the travel.
[[nodiscard]] bool follow(const host::MachineFile& file, const std::vector<std::size_t>& following,
                          const Vec3& ball, Pose& q);

// Deviations less that of the first pose: there the ball has been found.
[[nodiscard]] std::vector<PlaceReading> measure_sphere(sim::MotionCell& cell,
                                                       const MachineChain& chain,
                                                       const SpherePlan& plan);

}  // namespace volcomp::any_machine
