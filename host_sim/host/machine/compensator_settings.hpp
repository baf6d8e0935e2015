#pragma once

#include "comp/tick/instances.hpp"
#include "host_sim/host/machine/axis_kinds.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Settings of the compensator for a machine file: mm, rad and seconds turned into units and ticks.
// Throws UserError, with the setting and the axis, where rate or acceleration of an offset is less
// than a unit per tick (and tick), or more than a tick takes.
[[nodiscard]] OrientingCompensator::Settings compensator_settings(const CorrectionFile& correction,
                                                                  const AxisKinds& kinds);

}  // namespace volcomp::host
