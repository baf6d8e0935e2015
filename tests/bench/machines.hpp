#pragma once
// Machines, tables and position walks shared by the benchmarks.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "comp/tables/machine_tables.hpp"

namespace volcomp::bench {

// A serial machine: the first `tool_axes` axes carry the tool, the others the workpiece.
[[nodiscard]] constexpr MachineDescription serial_machine(std::array<JointKind, 5> kind,
                                                          std::array<Axis, 5> axis,
                                                          std::uint8_t tool_axes,
                                                          std::uint8_t axes) {
  MachineDescription m;
  m.body_count = static_cast<std::uint8_t>(axes + 1);
  for (std::uint8_t a = 0; a < axes; ++a) {
    Body& body = m.body[a + 1U];
    body.lower = a == tool_axes ? std::uint8_t{1} : static_cast<std::uint8_t>(a + 1);
    body.joint.kind = kind[a];
    body.joint.axis = axis[a];
    body.joint.nc_axis = a;
    body.joint.letter =
        kind[a] == JointKind::rotary ? static_cast<char>('A' + a) : static_cast<char>('X' + a);
    body.joint.sign = a < tool_axes ? std::int8_t{1} : std::int8_t{-1};
    body.joint.offset = {20.0 * a, 150.0 - 30.0 * a, 310.0};
  }
  m.tool_body = static_cast<std::uint8_t>(tool_axes + 1);
  m.work_body = tool_axes == axes ? std::uint8_t{1} : m.body_count;
  m.tool_point = {-173.7, 12.0, 30.0};
  m.correcting = {0, 1, 2};
  m.correcting_count = 3;
  return m;
}

inline constexpr JointKind kLinear = JointKind::prismatic;
inline constexpr JointKind kRotary = JointKind::rotary;

// X, Y, Z on the tool side.
inline constexpr MachineDescription kGeneric =
    serial_machine({kLinear, kLinear, kLinear}, {Axis::x, Axis::y, Axis::z}, 3, 3);

// X, Y, B carry the probe, A the gear; X, Y and B correct (docs/papers/l300g.md).
inline constexpr MachineDescription kGrinder = serial_machine(
    {kLinear, kLinear, kRotary, kRotary}, {Axis::x, Axis::y, Axis::y, Axis::x}, 3, 4);

// X, Y, Z carry the tool, A and C the workpiece.
inline constexpr MachineDescription kFiveAxis =
    serial_machine({kLinear, kLinear, kLinear, kRotary, kRotary},
                   {Axis::x, Axis::y, Axis::z, Axis::x, Axis::z}, 3, 5);

// Smooth tables over 500 mm or a turn, the latter with one knot in ten fewer: 81 and 73 by default.
inline constexpr std::size_t kKnots = 81;
[[nodiscard]] std::unique_ptr<MachineTables> make_tables(const MachineDescription& machine,
                                                         std::size_t knots = kKnots);

// Positions of a random walk of 0.1 to 2 mm (or mrad) per tick inside the tables, run-time units.
inline constexpr std::size_t kWalk = 4096;
using Walk = std::vector<std::array<std::int64_t, 5>>;
[[nodiscard]] Walk make_walk(const MachineDescription& machine);

}  // namespace volcomp::bench
