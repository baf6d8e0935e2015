#pragma once
// Touches of a plan through drives, latches and node: a controller moves the axes, the drives latch
// the edges of the probe, the node makes points of them.

#include <vector>

#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/controller/bus_axes.hpp"

namespace volcomp::self_calibration {

struct TouchingBus {
  sim::BusAxesFactory make_axes;
  double cycle_hz = sim::kBusCycle_hz;
};

// Latched positions, in the order of touch_all(). The node has tables of zeros: its points are
// where the nominal machine stands, and must agree with the latches. Throws UserError.
[[nodiscard]] std::vector<host::identify::LatchedTouch> touch_on_bus(
    const host::identify::MeasurementPlan& plan, const sim::PlanTruth& truth,
    const TouchingBus& bus, const host::Progress& progress);

}  // namespace volcomp::self_calibration
