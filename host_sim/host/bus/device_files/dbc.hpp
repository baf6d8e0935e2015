#pragma once
// A CAN database of one machine's bus, for log and trace tools.

#include <string>

#include "host_sim/host/bus/bus_settings.hpp"

namespace volcomp::host {

// The whole file; the same text for the same bus. Throws UserError as bus_messages().
[[nodiscard]] std::string make_dbc(const BusSettings& bus);

}  // namespace volcomp::host
