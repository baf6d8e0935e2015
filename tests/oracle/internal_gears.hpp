#pragma once
// The gear, wheel and machine of docs/papers/internal-helical.md.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/gears/flank_envelope.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {

inline constexpr double kDegree = kPi / 180.0;
inline constexpr std::array<FlankSide, 2> kBothSides{FlankSide::left, FlankSide::right};

// Before derive().
inline InternalGear given_gear(int teeth, double module, double helix_deg) {
  InternalGear gear;
  gear.teeth = teeth;
  gear.module = module;
  gear.pressure_angle = 20.0 * kDegree;
  gear.helix_angle = helix_deg * kDegree;
  return gear;
}

inline InternalGear gear_with(int teeth, double module, double helix_deg) {
  InternalGear gear = given_gear(teeth, module, helix_deg);
  EXPECT_TRUE(derive(gear).ok());
  return gear;
}

// Table 3 of the paper.
inline InternalGear paper_gear() { return gear_with(79, 2.0, 15.0); }

inline WheelSetup setup_for(const InternalGear& gear, double wheel_radius,
                            double off_swivel = 0.0) {
  WheelSetup setup;
  EXPECT_TRUE(wheel_setup(gear, wheel_radius, gear.helix_angle + off_swivel, setup).ok());
  return setup;
}

// From a little inside the tip to where the form circle ends, as the reference has it.
inline WheelProfile profile_for(const InternalGear& gear, const WheelSetup& setup, FlankSide side,
                                std::size_t knots) {
  WheelProfile profile;
  EXPECT_TRUE(wheel_profile(gear, setup, side, gear.r_tip - 0.1 * gear.module,
                            gear.r + 1.1 * gear.module, knots, profile)
                  .ok());
  return profile;
}

inline MachineChain grinder_chain(GrinderY y = GrinderY::none,
                                  const InternalGrinderOffsets& offsets = {}) {
  return chain_of(internal_grinder(y, offsets));
}

inline ContactInstant instant_of(const InternalGear& gear, const WheelSetup& setup,
                                 const FlankPlace& place) {
  ContactInstant instant;
  EXPECT_TRUE(contact_instant(gear, setup, place, instant).ok());
  return instant;
}

}  // namespace volcomp::test
