#pragma once
// The L300G as it really is, and the master gear on it.

#include "host_sim/experiments/l300g/machine_errors.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/artefacts/gear.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::l300g {

// `seed`: of the phases of the waves. Throws UserError when the machine has other axes than X Y B A
// or when a wave and a slope meet on an axis that turns all round.
[[nodiscard]] sim::TrueMachine make_l300g_truth(const host::MachineFile& file,
                                                const GrinderErrors& errors, std::uint64_t seed);

// z = 31, m = 4, 30 mm wide, d_a = 132 (the paper's Table 3).
[[nodiscard]] InvoluteGear master_gear();

// The gear's own deviation at roll length s and x, mm, the same on every flank: a slope and a wave
// over s, a slope and a wave over x, chosen to be of grade 4.
[[nodiscard]] double own_deviation(double s, double x);

}  // namespace volcomp::l300g
