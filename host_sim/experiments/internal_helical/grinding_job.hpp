#pragma once
// What a run grinds, from the machine file.

#include "comp/metrology/gears/form_wheel.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::sim {

// Throws UserError where the file has no [gear], [wheel] and [stroke], and for gears and strokes
// that monitor and tables have no room for.
[[nodiscard]] GrindingFile grinding_job(const MachineFile& machine);

// Swivelled by the helix angle, in to the root circle.
[[nodiscard]] WheelSetup form_wheel(const GrindingFile& job);

// Table 3 of the paper at the feed of its figures, which published and specified deviations are of.
[[nodiscard]] bool is_of_the_paper(const GrindingFile& job);

}  // namespace volcomp::sim
