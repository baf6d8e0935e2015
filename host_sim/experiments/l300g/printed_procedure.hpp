#pragma once
// What the paper's own readings of an axis give (docs/papers/l300g.md, "What is wrong in it", eq.
// 18 to 21).

#include <array>

#include "comp/metrology/fits/printed_procedure.hpp"
#include "host_sim/experiments/l300g/machine_errors.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::l300g {

struct PrintedProcedure {
  std::array<ReadingFigures, kGrinderAxes> own;  // of each axis along or about itself
  PrintedSolution x;                             // eq. 18 with the readings of X
};

// From readings without noise, each axis at its targets.
[[nodiscard]] PrintedProcedure printed_procedure(const sim::TrueMachine& truth,
                                                 const host::MachineFile& file);

// The mean of each error function over its targets, by NC axis: the most that readings of each axis
// can give when only their mean is taken.
[[nodiscard]] ErrorSet mean_errors(const sim::TrueMachine& truth, const host::MachineFile& file);

}  // namespace volcomp::l300g
