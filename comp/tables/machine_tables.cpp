#include "comp/tables/machine_tables.hpp"

#include "comp/core/units.hpp"

namespace volcomp {

// The lookup of a rotary axis counts 2^-32 turn: 256 units.
std::int64_t least_pitch(const Joint& joint) { return joint.kind == JointKind::rotary ? 256 : 1; }

// A table of a whole turn is periodic.
std::int64_t longest_travel(const Joint& joint, bool periodic) {
  if (joint.kind != JointKind::rotary) return (std::int64_t{1} << 32) - 1;
  return periodic ? kUnitsPerTurn : kUnitsPerTurn - 256;
}

Status check_knots(const TableGrid& table, const Joint& joint, std::size_t capacity) {
  Where where;
  where.axis = joint.letter;
  where.count = static_cast<int>(table.knots);
  if (table.knots < 2) return refuse(Reason::too_few_knots, where);
  // A double table repeats the first knot of a full turn.
  const std::size_t stored = table.knots + (table.periodic ? 1U : 0U);
  if (table.knots > capacity || stored > kTableKnots) return refuse(Reason::too_many_knots, where);
  where.count = -1;
  if (table.pitch < least_pitch(joint)) return refuse(Reason::pitch_not_positive, where);
  const std::int64_t segments = table.knots - (table.periodic ? 0 : 1);
  if (table.pitch > longest_travel(joint, table.periodic) / segments ||
      clamp_position(table.q0) != table.q0) {
    return refuse(Reason::travel_too_long, where);
  }
  const bool whole_turn =
      joint.kind == JointKind::rotary && kUnitsPerTurn - table.pitch * segments < segments;
  if (table.periodic && !whole_turn) return refuse(Reason::not_periodic, where);
  return {};
}

}  // namespace volcomp
