#pragma once
// The gear of the paper's Table 3.

#include <gtest/gtest.h>
#include "comp/core/units.hpp"
#include "comp/metrology/gears/involute_gear.hpp"

namespace volcomp::test {

inline InvoluteGear gear_of_the_paper(double helix_angle = 0.0) {
  InvoluteGear gear;
  gear.teeth = 31;
  gear.module = 4.0;
  gear.pressure_angle = 20.0 * kPi / 180.0;
  gear.helix_angle = helix_angle;
  gear.tip_diameter = 132.0;
  gear.width = 30.0;
  EXPECT_TRUE(derive(gear).ok());
  return gear;
}

}  // namespace volcomp::test
