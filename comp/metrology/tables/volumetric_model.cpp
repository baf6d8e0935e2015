#include "comp/metrology/tables/volumetric_model.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/quantise.hpp"

namespace volcomp {
namespace {

// A table over the full turn wraps, as in the tick; every other one holds its ends.
double wrapped(const ErrorTable& table, const Joint& joint, double q) {
  if (!is_full_turn(table, joint)) return q;
  return q - 2.0 * kPi * std::floor((q - table.q0) / (2.0 * kPi));
}

}  // namespace

ErrorSet VolumetricModel::errors(const Pose& q, const Travels& travels) const {
  ErrorSet set = zero_errors();
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    const Joint& joint = chain.axis(a);
    if (table[a] != nullptr) set[a] = table[a]->linear(wrapped(*table[a], joint, q[a]), travels[a]);
    if (joint.kind != JointKind::prismatic) continue;
    const double reached = table[a] != nullptr ? table[a]->clamp(q[a]) : q[a];
    set[a](static_cast<Eigen::Index>(joint.axis)) +=
        thermal_growth(joint, strain[a], reached, static_cast<double>(expansion[a].fixed_mm));
  }
  return set;
}

Pose VolumetricModel::held(const Pose& q) const {
  Pose inside = q;
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    if (table[a] != nullptr && !is_full_turn(*table[a], chain.axis(a)))
      inside[a] = table[a]->clamp(q[a]);
  }
  return inside;
}

Vec3 VolumetricModel::first_order(const Pose& q, const Travels& travels, Beyond beyond) const {
  const Pose at = beyond == Beyond::stand_at_end ? held(q) : q;
  const Vec3 squareness = squareness_translation(chain, at, directions);
  return first_order_error(chain, at, errors(at, travels), squareness,
                           ideal_points(chain, at, tool_point))
      .position_base;
}

Vec3 VolumetricModel::second_order(const Pose& q, const Travels& travels, Beyond beyond) const {
  const Pose at = beyond == Beyond::stand_at_end ? held(q) : q;
  const Vec3 squareness = squareness_translation(chain, at, directions);
  const VolumetricError error =
      exact_error(chain, at, errors(at, travels), squareness, RotationModel::second_order,
                  ideal_points(chain, at, tool_point));
  return chain.ideal(chain.work(), at).R * error.position_work;
}

void convert_to_internal(const Joint& joint, Convention convention, Side side, ErrorTable& table) {
  for (std::size_t i = 0; i < table.knots; ++i) {
    table.forward[i] = to_internal(table.forward[i], joint, table.knot(i), convention, side);
    table.backward[i] = to_internal(table.backward[i], joint, table.knot(i), convention, side);
  }
}

double first_order_distance(const VolumetricModel& model, int steps) {
  const MachineChain& chain = model.chain;
  const std::size_t axes = chain.axis_count();
  std::size_t total = 1;
  for (std::size_t a = 0; a < axes; ++a)
    total *= static_cast<std::size_t>(steps);
  double worst = 0.0;
  for (std::size_t point = 0; point < total; ++point) {
    Pose q{};
    std::size_t rest = point;
    for (std::size_t a = 0; a < axes; ++a) {
      const auto step = static_cast<double>(rest % static_cast<std::size_t>(steps));
      rest /= static_cast<std::size_t>(steps);
      const ErrorTable* table = model.table[a];
      if (table != nullptr) q[a] = table->q0 + (table->last() - table->q0) * step / (steps - 1);
    }
    const ErrorSet errors = model.errors(q, kUnknownTravels);
    const Vec3 squareness = squareness_translation(chain, q, model.directions);
    const PointPair points = ideal_points(chain, q, model.tool_point);
    const Vec3 exact =
        exact_error(chain, q, errors, squareness, RotationModel::rxryrz, points).position_work;
    const Vec3 first = first_order_error(chain, q, errors, squareness, points).position_work;
    worst = std::max(worst, (exact - first).norm());
  }
  return worst;
}

}  // namespace volcomp
