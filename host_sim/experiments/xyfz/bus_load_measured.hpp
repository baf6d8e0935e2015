#pragma once
// The measured part of the bus load.

#include <vector>

#include "host_sim/host/bus/bus_load.hpp"

namespace volcomp::xyfz {

// The XYFZ machine that comes with the program on the simulated bus, two seconds of machine time
// along a diagonal. Throws UserError when it cannot work at this rate.
[[nodiscard]] std::vector<host::MeasuredLoad> measure_bus_load(const std::vector<double>& cycle_hz);

}  // namespace volcomp::xyfz
