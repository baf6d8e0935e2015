#include "comp/metrology/tables/quantise.hpp"

#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

double units_of(const Joint& joint) {
  return joint.kind == JointKind::rotary ? kUnitsPerRad : kNmPerMm;
}

// Values of one column at the quantised knots: nm and rad in float.
void fill(const ErrorTable& from, Travel travel, double units, AxisTable& table,
          std::array<Channels, kTableKnots>& out) {
  for (std::uint32_t i = 0; i < table.knots; ++i) {
    const double q =
        static_cast<double>(table.q0 + table.pitch * static_cast<std::int64_t>(i)) / units;
    const ErrorMotion e = from.linear(q, travel);
    for (std::size_t c = 0; c < 6; ++c) {
      const double value = e(static_cast<Eigen::Index>(c)) * (c < 3 ? kNmPerMm : 1.0);
      out[i][c] = static_cast<float>(value);
    }
  }
}

}  // namespace

bool is_full_turn(const ErrorTable& table, const Joint& joint) {
  return joint.kind == JointKind::rotary && std::abs(table.last() - table.q0 - 2.0 * kPi) < 1e-9;
}

Status quantise(const ErrorTable& table, const Joint& joint, std::size_t capacity, AxisTable& out) {
  if (const Status s = check_table(table, joint.letter, capacity); !s.ok()) return s;
  Where where;
  where.axis = joint.letter;
  const double units = units_of(joint);
  const bool periodic = is_full_turn(table, joint);
  const auto segments = static_cast<std::int64_t>(table.knots - 1);
  const std::int64_t q0 = to_units(table.q0, units);
  const std::int64_t travel = periodic ? kUnitsPerTurn : to_units(table.last(), units) - q0;
  // A turn is rounded down, so that the knots never reach into the next one.
  const std::int64_t pitch = (travel + (periodic ? 0 : segments / 2)) / segments;
  if (pitch < least_pitch(joint)) return refuse(Reason::pitch_not_positive, where);
  if (pitch * segments > longest_travel(joint, periodic))
    return refuse(Reason::travel_too_long, where);
  for (const Travel direction : {Travel::forward, Travel::backward}) {
    if (!periodic) break;
    const ErrorMotion seam =
        table.at_knot(table.knots - 1, direction) - table.at_knot(0, direction);
    if (seam.cwiseAbs().maxCoeff() > 1e-9) return refuse(Reason::not_periodic, where);
  }
  out.q0 = q0;
  out.pitch = pitch;
  out.knots = static_cast<std::uint32_t>(periodic ? table.knots - 1 : table.knots);
  out.periodic = periodic;
  fill(table, Travel::forward, units, out, out.value[0]);
  fill(table, Travel::backward, units, out, out.value[1]);
  return {};
}

void dequantise(const AxisTable& table, const Joint& joint, ErrorTable& out) {
  const double units = units_of(joint);
  out.q0 = static_cast<double>(table.q0) / units;
  out.pitch = static_cast<double>(table.pitch) / units;
  out.knots = table.knots + (table.periodic ? 1U : 0U);
  for (std::size_t i = 0; i < out.knots; ++i) {
    const std::size_t from = i % table.knots;
    for (std::size_t c = 0; c < 6; ++c) {
      const double scale = c < 3 ? kNmPerMm : 1.0;
      const auto channel = static_cast<Eigen::Index>(c);
      out.forward[i](channel) = static_cast<double>(table.value[0][from][c]) / scale;
      out.backward[i](channel) = static_cast<double>(table.value[1][from][c]) / scale;
    }
  }
}

}  // namespace volcomp
