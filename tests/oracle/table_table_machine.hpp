#pragma once
// A machine of five axes that turns the workpiece about two of them.

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

// X, A and C carry the table, Y and Z the tool; with these signs of the linear joints.
inline MachineDescription table_table(int x = -1, int y = 1, int z = 1) {
  MachineDescription d;
  d.body_count = 6;
  d.body[1] = moving_body(1, JointKind::prismatic, Axis::x, x, 0, 'X', {0, 0, 200});
  d.body[2] = moving_body(2, JointKind::rotary, Axis::x, -1, 3, 'A', {50, 20, 180});
  d.body[3] = moving_body(3, JointKind::rotary, Axis::z, -1, 4, 'C', {0.1, 35, 60});
  d.body[4] = moving_body(1, JointKind::prismatic, Axis::y, y, 1, 'Y', {40, 300, 700});
  d.body[5] = moving_body(5, JointKind::prismatic, Axis::z, z, 2, 'Z', {0, -150, 80});
  d.work_body = 4;
  d.tool_body = 6;
  d.tool_point = {2, -3, -220};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

inline AxisTable whole_turn(std::uint32_t knots, double delta_nm, double epsilon, Random& random) {
  AxisTable t = random_table(kTurn / 7, kTurn / knots, knots, delta_nm, epsilon, random);
  t.periodic = true;
  return t;
}

}  // namespace volcomp::test
