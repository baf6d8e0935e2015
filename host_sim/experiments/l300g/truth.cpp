#include "host_sim/experiments/l300g/truth.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/gear_inspection.hpp"
#include "host_sim/host/measure/involute_gear_file.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::l300g {
namespace {

// An error that repeats with every turn cannot rise without end. 4/3 sin q − 1/6 sin 2q rises like
// q where it begins: 0.13 % less at 25°, where the flank of a tooth ends.
void let_rise_and_return(sim::ErrorFunction& f, double slope) {
  f.amplitude[1] = 4.0 / 3.0 * slope;
  f.ripple = -slope / 6.0;
  f.ripple_period = kPi;
}

sim::TrueAxis true_axis(const host::AxisFile& file, const AxisErrors& errors, double sign,
                        sim::Random& random) {
  sim::TrueAxis axis;
  axis.lo = file.lo;
  axis.hi = file.hi;
  for (std::size_t c = 0; c < 6; ++c) {
    sim::ErrorFunction& f = axis.channel[c];
    f.constant = sign * errors.constant[c];
    const bool sloping = std::abs(errors.slope[c]) > 0.0;
    if (sloping && file.full_turn()) {
      if (errors.waves())
        throw host::UserError(fmt::format("axis {}: a slope and a wave at once", file.letter));
      let_rise_and_return(f, sign * errors.slope[c]);
    } else if (sloping) {
      f.linear = sign * errors.slope[c] * (file.hi - file.lo);
      f.constant += sign * errors.slope[c] * file.lo;
    }
    if (!errors.waves()) continue;
    f.ripple = sign * (c < 3 ? errors.wave_mm : errors.wave_rad);
    f.ripple_period = errors.wave_period;
    f.ripple_phase = random.uniform(0.0, 2.0 * kPi);
  }
  return axis;
}

MachineChain with_arm(const host::MachineFile& file, double longer_mm) {
  MachineDescription description = file.chain.description();
  description.tool_point[0] -= longer_mm;
  MachineChain chain;
  host::require(MachineChain::build(description, chain), file.path);
  return chain;
}

}  // namespace

sim::TrueMachine make_l300g_truth(const host::MachineFile& file, const GrinderErrors& errors,
                                  std::uint64_t seed) {
  file.expect_axes("XYBA");
  sim::Random random(seed);
  sim::TrueMachine machine;
  machine.chain = with_arm(file, errors.arm_mm);
  for (std::size_t a = 0; a < kGrinderAxes; ++a) {
    // TrueMachine holds relative values.
    const double sign = branch_sign(machine.chain.axis(a).branch);
    machine.axis[a] = true_axis(file.axes[a], errors.axis[a], sign, random);
  }
  return machine;
}

InvoluteGear master_gear() {
  InvoluteGear gear;
  gear.teeth = 31;
  gear.module = 4.0;
  gear.pressure_angle = 20.0 * kPi / 180.0;
  gear.tip_diameter = 132.0;
  gear.width = 30.0;
  host::require(derive(gear), "master gear");
  return gear;
}

InvoluteGear gear_to_measure(const std::filesystem::path& file) {
  if (file.empty()) return master_gear();
  const InvoluteGear gear = host::read_involute_gear(file);
  if (std::abs(gear.helix_angle) > 0.0)
    throw host::UserError(file.string() +
                          ": helix_angle_deg: the grinder measures spur gears only");
  return gear;
}

// To a micrometre, as the published case of the master gear states its ranges.
OwnDeviation::OwnDeviation(const InvoluteGear& gear) {
  const auto to_micrometre = [](double mm) { return std::round(1e3 * mm) / 1e3; };
  const EvaluationRange profile = host::profile_range(gear, 0.92);
  const EvaluationRange lead = host::lead_range(gear);
  s0_ = to_micrometre(profile.low);
  s_range_ = to_micrometre(profile.high - profile.low);
  x0_ = to_micrometre(lead.low);
  x_range_ = to_micrometre(lead.high - lead.low);
}

double OwnDeviation::operator()(double s, double x) const {
  const double u = (s - s0_) / s_range_;
  const double um = 3.4 * u + 2.2 * std::sin(3.0 * kPi * u) + 3.2 * x / x_range_ +
                    1.85 * std::sin(3.0 * kPi * (x - x0_) / x_range_);
  return 1e-3 * um;
}

}  // namespace volcomp::l300g
