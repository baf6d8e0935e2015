#pragma once
// The L300G as it really is, and the gear on it.

#include <filesystem>

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

// The master gear where `file` is empty. Throws UserError naming file, line and field; a helical
// gear is refused: all touches lie in transverse planes.
[[nodiscard]] InvoluteGear gear_to_measure(const std::filesystem::path& file);

// What is wrong with the gear itself, the same on every flank: a slope and a wave over the roll
// length, a slope and a wave over x, over the evaluation ranges of profile and lead. Chosen to be
// of grade 4 on the master gear.
class OwnDeviation {
 public:
  explicit OwnDeviation(const InvoluteGear& gear);
  // At roll length s and x, mm, normal to the flank.
  [[nodiscard]] double operator()(double s, double x) const;

 private:
  double s0_;
  double s_range_;
  double x0_;
  double x_range_;
};

}  // namespace volcomp::l300g
