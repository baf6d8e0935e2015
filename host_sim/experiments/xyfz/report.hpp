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

// Both in two pieces: what does not depend on the noisy campaigns, and what these add.
[[nodiscard]] nlohmann::json noise_free_figures(const XyfzResult& result);
void add_draw_figures(const XyfzResult& result, nlohmann::json& figures);
[[nodiscard]] host::Verdict noise_free_verdict(const XyfzResult& result);
void add_draw_verdict(const XyfzResult& result, host::Verdict& verdict);

// What was tuned, and the instruments of the noisy campaigns, a sentence each.
[[nodiscard]] nlohmann::json tuned_text(const XyfzTuning& tuning);
[[nodiscard]] std::vector<std::string> instruments_of(const XyfzOptions& options,
                                                      const sim::NoiseClasses& noise);

}  // namespace volcomp::xyfz
