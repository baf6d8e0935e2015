#include "tests/bench/machines.hpp"

#include <cmath>
#include <cstdlib>
#include <random>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/quantise.hpp"

namespace volcomp::bench {
namespace {

ErrorTable smooth_table(bool rotary, std::size_t knots, double phase) {
  ErrorTable t;
  t.q0 = rotary ? 0.0 : -500.0;
  t.knots = rotary ? knots - knots / 10 : knots;
  t.pitch = (rotary ? 2.0 * kPi : 500.0) / static_cast<double>(t.knots - 1);
  const double wave = rotary ? 2.0 : 0.011;
  for (std::size_t i = 0; i < t.knots; ++i) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      const double size = c < 3 ? 4e-3 : 2e-5;
      const std::size_t k = rotary && i + 1 == t.knots ? 0 : i;  // closed exactly
      t.forward[i](c) = size * std::sin(wave * t.knot(k) + phase + static_cast<double>(c));
      t.backward[i](c) = t.forward[i](c) + 0.1 * size;
    }
  }
  return t;
}

void require(const Status& status) {
  if (!status.ok()) std::abort();
}

}  // namespace

std::unique_ptr<MachineTables> make_tables(const MachineDescription& machine, std::size_t knots) {
  auto tables = std::make_unique<MachineTables>();
  tables->machine = machine;
  tables->directions = zero_directions();
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    const auto table = std::make_unique<ErrorTable>(
        smooth_table(joint.kind == JointKind::rotary, knots, static_cast<double>(k)));
    require(quantise(*table, joint, 128, tables->axis[joint.nc_axis]));
  }
  return tables;
}

Walk make_walk(const MachineDescription& machine) {
  std::mt19937_64 engine(20200885);
  std::uniform_real_distribution<double> step(0.1, 2.0);
  Walk walk(kWalk);
  for (std::size_t k = 0; k < machine.body_count; ++k) {
    const Joint& joint = machine.body[k].joint;
    if (!joint.moves()) continue;
    const bool rotary = joint.kind == JointKind::rotary;
    const double lo = rotary ? -0.5 : -490.0;  // small tilts keep the authority
    const double hi = rotary ? 0.5 : -10.0;
    double q = 0.5 * (lo + hi);
    double direction = 1.0;
    for (auto& position : walk) {
      if (engine() % 64 == 0) direction = -direction;
      q += direction * step(engine) * (rotary ? 1e-3 : 1.0);
      if (q > hi) direction = -1.0;
      if (q < lo) direction = 1.0;
      position[joint.nc_axis] = to_units(q, rotary ? kUnitsPerRad : kNmPerMm);
    }
  }
  return walk;
}

}  // namespace volcomp::bench
