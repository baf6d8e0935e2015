#pragma once
// The true XYFZ machine: amplitudes by class, phases from a seed, two quantities tuned
// (docs/papers/xyfz.md, "What stays open").

#include <optional>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::xyfz {

// The two quantities tuned so that, noise-free, the PNP diagonal shows the paper's figures. Nothing
// about the optimised models is tuned.
struct XyfzTuning {
  double angle_scale = 1.0;  // of all nine angular error functions
  double scale_error = 0.0;  // added slope of EXX, mm/mm
};

inline constexpr double kPaperRaw_um = 41.15;
inline constexpr double kPaperNaive_um = 16.37;

// The machine of a phase seed. Squareness is chosen so that a perfect ball bar at the place of the
// machine file reads the values of the machine file (the paper's Table 6).
[[nodiscard]] sim::TrueMachine make_xyfz_truth(const host::MachineFile& file,
                                               std::uint64_t phase_seed, const XyfzTuning& tuning);

// The tuning for a phase seed; where that seed cannot show the paper's figures, none, or UserError.
// Both throw UserError for a file of another kind of machine.
[[nodiscard]] std::optional<XyfzTuning> find_tuning(const host::MachineFile& file,
                                                    std::uint64_t phase_seed);
[[nodiscard]] XyfzTuning tune_xyfz(const host::MachineFile& file, std::uint64_t phase_seed);

// The tuned machine of a phase seed, where the file has the paper's chain and travels with which
// that seed can show the paper's figures.
[[nodiscard]] std::optional<sim::TrueMachine> xyfz_truth(const host::MachineFile& file,
                                                         std::uint64_t phase_seed);

}  // namespace volcomp::xyfz
