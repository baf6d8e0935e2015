#pragma once
// Any machine there is a file of: drawn at random with errors, measured, compensated, measured
// again along its diagonals, all over its travel and with a ball on its table.

#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/experiments/any_machine/verification.hpp"
#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/machine/machine_facts.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/rotary_locations.hpp"
#include "host_sim/sim/controller/integrated_axes.hpp"

namespace volcomp::any_machine {

struct MachineOptions {
  std::filesystem::path machine;
  std::uint64_t seed = 1;             // of the machine, its places and the noise
  bool noise = false;                 // realistic instruments
  std::size_t runs = 5;               // bidirectional, per axis, with noise
  std::size_t places = 100;           // all over the travel
  std::size_t knots = kDefaultKnots;  // per table: what the node has room for
  double tool_length_mm = 100.0;      // for the effect of orientation errors
  sim::CellFactory make_cell = sim::make_integrated_cell;
};

struct MachineResult {
  MachineOptions options;
  host::MachineFile machine;
  SpherePlan sphere;
  host::LeastAuthority authority;
  sim::RotaryLocations locations;  // as measured
  MachineState before;
  MachineState after;
  std::vector<std::string> warnings;  // of the tables
  std::vector<host::HashedInput> inputs;

  // What a tool longer by options.tool_length_mm is off for its orientation alone, and for what of
  // it the orienting axes reach.
  [[nodiscard]] double effect_um(const MachineState& state) const;
  [[nodiscard]] double steerable_um(const MachineState& state) const;
};

// With errors of one's own. Throws UserError.
[[nodiscard]] MachineResult run_machine_with(const host::MachineFile& file,
                                             const sim::TrueMachine& truth,
                                             const MachineOptions& options,
                                             const host::Progress& progress);
[[nodiscard]] MachineResult run_machine(const MachineOptions& options,
                                        const host::Progress& progress);

}  // namespace volcomp::any_machine
