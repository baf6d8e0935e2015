#pragma once
// Where rotary axes are, in the runs of a campaign and in its machine file.

#include <array>

#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/truth/average_line.hpp"

namespace volcomp::sim {

// Runs tell nothing of where a rotary axis is: its instrument is set up on the axis itself. Takes
// out what they hold of it, their mean in the fixed frame (ISO 230-7, axis average line).
void forget_places(Campaign& campaign);

// Puts every rotary axis where it was found: in the runs what changes as the axis turns, in the
// machine file what it is at the reference.
void put_in_place(const std::array<AverageLine, kMaxAxes>& place, Campaign& campaign);

}  // namespace volcomp::sim
