// Cases of docs/papers/internal-helical.md: what errors of the axes leave on the flank.

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/gears/flank_envelope.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s3_case.hpp"

namespace volcomp::cases {
namespace {

MachineChain paper_machine() {
  MachineChain chain;
  require(MachineChain::build(internal_grinder(GrinderY::none), chain));
  return chain;
}

// The error functions of a case.
class AxisErrors {
 public:
  explicit AxisErrors(const json& in) : in_(in) {}

  ErrorSet operator()(const Pose& q) const {
    ErrorSet errors = zero_errors();
    for (const auto& [letter, nc_axis] : {std::pair{"X", kGrinderX}, std::pair{"Z", kGrinderZ},
                                          std::pair{"C", kGrinderC}, std::pair{"A", kGrinderA}}) {
      if (in_.contains(letter)) errors[nc_axis] = value(in_.at(letter), q[nc_axis]);
    }
    return errors;
  }

 private:
  static ErrorMotion value(const json& in, double q) {
    ErrorMotion v = six(in.at("v"));
    if (in.at("shape") == "const") return v;
    const double scale = number(in.at("scale"));
    if (in.at("shape") == "linear") return v * (q / scale);
    return v * std::sin(2.0 * kPi * q / scale + number(in.at("phase")));
  }

  const json& in_;
};

json flank_error(const json& in) {
  const InternalGear gear = internal_gear_of(in.at("gear"));
  const WheelSetup setup = setup_of(in);
  const MachineChain chain = paper_machine();
  const AxisErrors errors(in.at("errors"));
  ContactInstant instant;
  require(contact_instant(gear, setup, {side_of(in), number(in.at("r")), number(in.at("zP"))},
                          instant));
  const Pose q = grinding_pose(gear, setup, instant.stroke);
  const LeftError error = left_error(chain, q, errors(q));
  WheelProfile profile;
  require(wheel_profile(gear, setup, side_of(in), gear.r_tip - 0.3, gear.r + 1.1 * gear.module,
                        kWheelKnots, profile));
  double exact = 0.0;
  require(exact_flank_deviation(chain, gear, setup, profile, instant, errors, exact));
  const double dn = flank_deviation(instant, error);
  return {{"alpha", instant.c},
          {"z_wheel", instant.stroke},
          {"P", to_json(instant.P)},
          {"n", to_json(instant.n)},
          {"delta", to_json(error.delta)},
          {"eps", to_json(error.eps)},
          {"dn_first_order", dn},
          {"dn_exact", exact},
          {"dt_transverse", transverse_of(gear, dn)},
          {"arc", pitch_arc_of(gear, dn)}};
}

json probe_point(const json& in) {
  const InternalGear gear = internal_gear_of(in.at("gear"));
  double dn = 0.0;
  require(space_flank_deviation(gear, side_of(in), 0, vector3(in.at("P")), dn));
  return {{"dn", dn},
          {"rb", gear.r_b},
          {"p", gear.screw_parameter()},
          {"beta_b", gear.beta_b},
          {"r", gear.r}};
}

json sync(const json& in) {
  const InternalGear gear = internal_gear_of(in.at("gear"));
  const WheelSetup setup = setup_of(in);
  const MachineChain chain = paper_machine();
  ErrorSet errors = zero_errors();
  errors[kGrinderX](0) = number(in.at("e_x"));
  errors[kGrinderZ](2) = number(in.at("e_z"));
  errors[kGrinderC](5) = number(in.at("e_c"));
  const auto dn = [&](FlankSide side) {
    ContactInstant instant;
    require(contact_instant(gear, setup, {side, number(in.at("r")), number(in.at("zP"))}, instant));
    const Pose q = grinding_pose(gear, setup, instant.stroke);
    return flank_deviation(instant, left_error(chain, q, errors));
  };
  const double e_s = synchronisation_error(gear, number(in.at("e_z")), number(in.at("e_c")));
  return {{"dn_plus", dn(FlankSide::left)},
          {"dn_minus", dn(FlankSide::right)},
          {"sync_rad", e_s},
          {"sync_flank_mm", synchronisation_on_flank(gear, e_s)}};
}

}  // namespace

void add_s3_flank(Handlers& handlers) {
  handlers["s3.flank_error"] = flank_error;
  handlers["s3.probe_point"] = probe_point;
  handlers["s3.sync"] = sync;
}

}  // namespace volcomp::cases
