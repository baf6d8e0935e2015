#pragma once
// Shared by the cases of docs/papers/l300g.md: lists, joints, the L300G, gears.

#include <vector>

#include "comp/metrology/gears/involute_gear.hpp"
#include "tests/cases/case_file.hpp"
#include "tests/oracle/l300g_machine.hpp"

namespace volcomp::cases {

[[nodiscard]] Mat3 matrix(const json& rows);
[[nodiscard]] json rows_of(const Mat3& m);
[[nodiscard]] Joint joint_of(const json& in);
[[nodiscard]] InvoluteGear gear_of(const json& in);
// `side` and `tooth` of a case.
[[nodiscard]] Flank flank_of(const json& in);

// Piecewise linear between nodes, held outside; `held`: q is outside. At least one node.
[[nodiscard]] ErrorMotion interpolate_motion(Span<const double> nodes,
                                             Span<const ErrorMotion> motion, double q, bool& held);

struct L300gCase {
  explicit L300gCase(const json& in);

  SwingArm arm;
  L300gDatum datum;
  MachineChain chain;
};

}  // namespace volcomp::cases
