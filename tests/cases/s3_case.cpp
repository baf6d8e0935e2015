#include "tests/cases/s3_case.hpp"

#include "comp/core/units.hpp"

namespace volcomp::cases {

InternalGear internal_gear_of(const json& in) {
  InternalGear gear;
  gear.teeth = in.at("z").get<int>();
  gear.module = number(in.at("mn"));
  gear.pressure_angle = number(in.at("an_deg")) * kPi / 180.0;
  gear.helix_angle = number(in.at("beta_deg")) * kPi / 180.0;
  gear.profile_shift = number(in.at("xn"));
  require(derive(gear));
  return gear;
}

FlankSide side_of(const json& in) {
  return in.at("side").get<int>() > 0 ? FlankSide::left : FlankSide::right;
}

WheelSetup setup_of(const json& in) { return {number(in.at("x")), number(in.at("A"))}; }

}  // namespace volcomp::cases
