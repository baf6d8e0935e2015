#pragma once
// Shared by the cases of docs/papers/l300g.md: lists, joints, the L300G, gears.

#include <vector>

#include "comp/metrology/gears/involute_gear.hpp"
#include "comp/metrology/gears/l300g.hpp"
#include "tests/cases/case_file.hpp"

namespace volcomp::cases {

[[nodiscard]] std::vector<double> numbers(const json& list);
[[nodiscard]] Mat3 matrix(const json& rows);
[[nodiscard]] json rows_of(const Mat3& m);
[[nodiscard]] Joint joint_of(const json& in);
[[nodiscard]] InvoluteGear gear_of(const json& in);
// `side` and `tooth` of a case.
[[nodiscard]] Flank flank_of(const json& in);

struct L300gCase {
  explicit L300gCase(const json& in);

  SwingArm arm;
  L300gDatum datum;
  MachineChain chain;
};

}  // namespace volcomp::cases
