#pragma once
// A machine many times: other errors, other places and other noise of the instruments each time.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/judged_spread.hpp"
#include "host_sim/experiments/any_machine/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::any_machine {

struct MachineSpread {
  MachineOptions options;  // of the first
  host::MachineFile machine;
  std::vector<host::HashedInput> inputs;
  std::vector<JudgedMachine> drawn;  // seeds options.seed, options.seed + 1, …

  [[nodiscard]] std::size_t good() const;
};

// `count` machines on up to `threads` threads; the same result for any number of these. Throws
// UserError.
[[nodiscard]] MachineSpread run_machine_spread(const MachineOptions& options, std::size_t count,
                                               std::size_t threads, const host::Progress& progress);

// Good: 15 of 16 machines are, in the same proportion for other numbers.
[[nodiscard]] host::Verdict machine_spread_verdict(const MachineSpread& spread);
[[nodiscard]] std::string machine_spread_summary(const MachineSpread& spread);
[[nodiscard]] nlohmann::json machine_spread_document(const MachineSpread& spread,
                                                     const host::RunContext& run);
[[nodiscard]] nlohmann::json machine_spread_figures(const MachineSpread& spread);

}  // namespace volcomp::any_machine
