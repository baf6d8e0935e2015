#pragma once
// The campaigns of the XYFZ machine in parts (parts_of_run.hpp).

#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/parts_of_run.hpp"

namespace volcomp::xyfz {

// What belongs to the draws of options.shard, and what is alike in all parts.
[[nodiscard]] host::PartialRun part_of_xyfz(const XyfzResult& result);

// Of all parts together: the figures of the whole run, and its verdict.
struct CollectedXyfz {
  nlohmann::json figures;
  host::Verdict verdict;
};
[[nodiscard]] CollectedXyfz collect_xyfz(const host::PartialRun& all);

}  // namespace volcomp::xyfz
