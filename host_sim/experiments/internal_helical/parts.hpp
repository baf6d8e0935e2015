#pragma once
// The grinders of a run in parts (host/report/parts_of_run.hpp).

#include "host_sim/experiments/internal_helical/scenario.hpp"
#include "host_sim/host/report/document.hpp"

namespace volcomp::internal_helical {

// The seeds of options.shard, and what is alike in all parts.
[[nodiscard]] host::PartialRun part_of_helical(const InternalHelicalResult& run);

// Of all parts together: the figures of the whole run, and its verdict. Throws UserError.
struct CollectedHelical {
  nlohmann::json figures;
  host::Verdict verdict;
};
[[nodiscard]] CollectedHelical collect_helical(const host::PartialRun& all);

}  // namespace volcomp::internal_helical
