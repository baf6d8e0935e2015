#pragma once
// The following error at a reversal, for people and for programs.

#include <string>

#include <nlohmann/json.hpp>

#include "host_sim/experiments/reversal/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::reversal {

[[nodiscard]] std::string reversal_summary(const ReversalResult& result);
[[nodiscard]] nlohmann::json reversal_figures(const ReversalResult& result);
[[nodiscard]] nlohmann::json reversal_document(const ReversalResult& result,
                                               const host::RunContext& run);

}  // namespace volcomp::reversal
