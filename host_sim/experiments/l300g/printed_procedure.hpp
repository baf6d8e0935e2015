#pragma once
// What the paper's own readings of an axis give (docs/papers/l300g.md, "What is wrong in it", eq.
// 18 to 21), beside what targets give.

#include <array>

#include "comp/metrology/fits/printed_procedure.hpp"
#include "host_sim/experiments/l300g/machine_errors.hpp"
#include "host_sim/sim/campaign/identification.hpp"

namespace volcomp::l300g {

struct PrintedProcedure {
  std::array<ReadingFigures, kGrinderAxes> own;  // of each axis along or about itself
  PrintedSolution x;                             // eq. 18 with the readings of X
};

[[nodiscard]] PrintedProcedure printed_procedure(const sim::Identification& found,
                                                 const host::MachineFile& file);

}  // namespace volcomp::l300g
