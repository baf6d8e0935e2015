#pragma once
// A machine many times: other errors, other places and other noise of the instruments each time.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/judged_spread.hpp"
#include "host_sim/experiments/any_machine/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/draws_of_run.hpp"

namespace volcomp::any_machine {

// NOLINTNEXTLINE(bugprone-exception-escape): nothing in nlohmann::json throws when moved
struct MachineSpread {
  nlohmann::json settings;  // all of them, and hashes of the inputs, for programs
  MachineOptions options;   // of the first
  std::string machine;      // its name
  std::string chain;
  std::vector<host::HashedInput> inputs;
  std::vector<JudgedMachine> drawn;  // seeds options.seed, the next, …, or those of a shard

  [[nodiscard]] std::size_t good() const;
};

// Draw i is the machine of seed options.seed + i. Throws UserError.
[[nodiscard]] MachineSpread run_machine_spread(const MachineOptions& options,
                                               const host::DrawPlan& plan,
                                               const host::Progress& progress);

// In parts, and of all of them together again.
[[nodiscard]] host::PartialRun part_of_machine_spread(const MachineSpread& spread,
                                                      const host::DrawPlan& plan);
[[nodiscard]] MachineSpread collect_machine_spread(const host::PartialRun& all);

// Good: 15 of 16 machines are, in the same proportion for other numbers.
[[nodiscard]] host::Verdict machine_spread_verdict(const MachineSpread& spread);
[[nodiscard]] std::string machine_spread_summary(const MachineSpread& spread);
[[nodiscard]] nlohmann::json machine_spread_document(const MachineSpread& spread,
                                                     const host::RunContext& run);
[[nodiscard]] nlohmann::json machine_spread_figures(const MachineSpread& spread);

}  // namespace volcomp::any_machine
