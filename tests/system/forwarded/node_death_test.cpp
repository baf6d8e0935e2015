// The node dies while axes are on a circle: who notices it first matters, as the table of
// docs/drives.md says (tests/bench/node_death_bench.cpp).

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/system/forwarded/node_death.hpp"

namespace volcomp::sim {
namespace {

using Missing = DriveBehaviour::MissingTarget;

// At six places of the circle.
double worst_mm(DeathWatch watch, bool both_forwarded) {
  double worst = 0.0;
  const int turn = death_cycles(1.0);
  for (int place = 0; place < 6; ++place)
    worst = std::max(worst,
                     path_error_mm({watch, Missing::held, both_forwarded, 1.0}, place * turn / 6));
  return worst;
}

// The axis that the node does not serve goes on until somebody notices.
TEST(DeathOfTheNode, CostsMoreTheLaterItIsNoticed) {
  const double controller = worst_mm(DeathWatch::controller, false);
  const double timer = worst_mm(DeathWatch::rpdo_timer, false);
  const double heartbeat = worst_mm(DeathWatch::heartbeat, false);
  EXPECT_LT(worst_mm(DeathWatch::nobody, false), controller);
  EXPECT_LT(controller, timer);
  EXPECT_LT(timer, heartbeat);
}

// Axes that get nothing any more stop together, where they are.
TEST(DeathOfTheNode, CostsLittleWhereAllAxesAreForwardedAndHold) {
  EXPECT_LT(worst_mm(DeathWatch::heartbeat, true), 1.0);
}

}  // namespace
}  // namespace volcomp::sim
