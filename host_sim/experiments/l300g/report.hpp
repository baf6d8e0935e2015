#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/l300g/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::l300g {

// A run as a report document (host_sim/host/report/page/README.md).
[[nodiscard]] nlohmann::json l300g_document(const L300gResult& result, const host::RunContext& run);
// The same for a terminal.
[[nodiscard]] std::string l300g_summary(const L300gResult& result);

}  // namespace volcomp::l300g
