#pragma once
// The report document of a run on the grinder (host_sim/host/report/page/README.md).

#include <nlohmann/json.hpp>

#include "host_sim/experiments/internal_helical/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::internal_helical {

[[nodiscard]] nlohmann::json internal_helical_document(const InternalHelicalResult& result,
                                                       const host::RunContext& run);
// The same for a terminal.
[[nodiscard]] std::string internal_helical_summary(const InternalHelicalResult& result);

}  // namespace volcomp::internal_helical
