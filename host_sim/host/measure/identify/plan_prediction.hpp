#pragma once
// What a measurement plan will see, before anything is measured.

#include <optional>
#include <vector>

#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/plan_file.hpp"
#include "host_sim/host/measure/identify/rank.hpp"
#include "host_sim/host/measure/identify/weakest.hpp"
#include "host_sim/host/report/progress.hpp"

namespace volcomp::host::identify {

struct PlanPrediction {
  PlanRank rank;
  bool solvable = false;                 // with gauge and what is known beforehand
  std::vector<FoundFunction> functions;  // uncertainties, values 0
  std::vector<FoundValue> values;
  std::optional<FoundSquareness> squareness;
  FoundVolume volume;
  std::vector<VolumeSection> sections;
  std::vector<WeakValue> weakest;
  std::vector<std::size_t> order;  // of set-ups: each adds most to those before
  std::vector<double> rms_u;       // mm, after each, with a weak prior
  Index unknowns = 0;
  Index rows = 0;
};
[[nodiscard]] PlanPrediction predict_plan(const MeasurementPlan& plan, const Progress& progress);

}  // namespace volcomp::host::identify
