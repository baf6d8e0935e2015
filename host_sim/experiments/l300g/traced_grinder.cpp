#include "host_sim/experiments/l300g/traced_grinder.hpp"

namespace volcomp::l300g {

sim::TracedPlan traced_plan() {
  constexpr std::size_t kX = 0;
  constexpr std::size_t kY = 1;
  constexpr std::size_t kB = 2;
  constexpr std::size_t kA = 3;
  const host::identify::Channels all{0, 1, 2, 3, 4, 5};
  sim::TracedPlan plan;
  host::identify::ErrorModel& model = plan.model;
  model.functions.at(kX) = {22, all, {}};
  model.functions.at(kY) = {14, all, {}};
  model.functions.at(kB) = {50, all, {}};
  model.functions.at(kA) = {36, all, {}};
  // How B lies, and where the ball stands against it: its own place is that of the work, which A
  // has.
  model.location.at(kB) = {3, 5};
  model.constant.at(kB) = {0, 2};
  model.location.at(kA) = {1, 2, 4, 5};
  model.constant.at(kA) = all;
  // The bed turned is no error: Y is along it, and X has no slope towards Z.
  model.gauge = {{kY, 0}, {kY, 2}, {kX, 2}};
  plan.reflectors = {{0.0, 60.0, 0.0}, {0.0, 0.0, 60.0}, {60.0, 0.0, 30.0}};
  plan.places = 600;
  return plan;
}

}  // namespace volcomp::l300g
