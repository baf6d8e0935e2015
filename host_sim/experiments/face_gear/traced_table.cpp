#include "host_sim/experiments/face_gear/traced_table.hpp"

#include <cmath>

namespace volcomp::face_gear {

sim::TracedPlan traced_plan(double slide_step_mm) {
  constexpr std::size_t kSlideX = 0;
  constexpr std::size_t kSlideY = 1;
  constexpr std::size_t kSlideZ = 2;
  constexpr std::size_t kTable = 3;
  const host::identify::Channels all{0, 1, 2, 3, 4, 5};
  sim::TracedPlan plan;
  host::identify::ErrorModel& model = plan.model;
  for (const std::size_t slide : {kSlideX, kSlideY, kSlideZ})
    model.functions.at(slide) = {8, all, {}};
  model.functions.at(kTable) = {12, all, {}};
  model.location.at(kTable) = {0, 1, 3, 4};
  model.constant.at(kTable) = all;
  // The bed turned is no error: Y is along it, and X has no slope towards Z.
  model.gauge = {{kSlideY, 0}, {kSlideY, 2}, {kSlideX, 2}};
  plan.reflectors = {{60.0, 0.0, 30.0}, {0.0, 60.0, 30.0}, {0.0, 0.0, -80.0}};
  plan.places = 400;
  plan.repeatability_mm = slide_step_mm / std::sqrt(12.0);
  return plan;
}

}  // namespace volcomp::face_gear
