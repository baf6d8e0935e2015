#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::xyfz {

// The figures of a run under the names the README documents.
[[nodiscard]] nlohmann::json xyfz_figures(const XyfzResult& result);

// The same run as a report document (host_sim/host/report/page/README.md).
[[nodiscard]] nlohmann::json xyfz_document(const XyfzResult& result, const host::RunContext& run);

// The before/after table for a terminal.
[[nodiscard]] std::string xyfz_summary(const XyfzResult& result);

[[nodiscard]] host::Verdict xyfz_verdict(const XyfzResult& result);

}  // namespace volcomp::xyfz
