#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/scenario.hpp"
#include "host_sim/host/report/before_after.hpp"

namespace volcomp::any_machine {

// The figures of a run under the names docs/machine-file.md documents.
[[nodiscard]] nlohmann::json machine_figures(const MachineResult& result);

// Largest deviations that the verdict is about, µm.
[[nodiscard]] std::vector<host::BeforeAfter> judged_figures(const MachineResult& result);

// Good when what was off by micrometres is off by a tenth or a micrometre; with noise by half or
// five.
[[nodiscard]] host::Verdict machine_verdict(const MachineResult& result);

// "X Y Z", and "A C" of those that orient the tool
[[nodiscard]] std::string correcting_letters(const host::MachineFile& machine);
[[nodiscard]] std::string orienting_letters(const host::MachineFile& machine);

}  // namespace volcomp::any_machine
