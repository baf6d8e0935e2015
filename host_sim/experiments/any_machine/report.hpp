#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::any_machine {

// A run as a report document (host_sim/host/report/page/README.md).
[[nodiscard]] nlohmann::json machine_document(const MachineResult& result,
                                              const host::RunContext& run);
// The same for a terminal.
[[nodiscard]] std::string machine_summary(const MachineResult& result);

}  // namespace volcomp::any_machine
