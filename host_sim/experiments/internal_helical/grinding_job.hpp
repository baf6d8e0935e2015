#pragma once
// What a run grinds, from the machine file.

#include "comp/metrology/gears/form_wheel.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::internal_helical {

// Throws UserError where the file has no [gear], [wheel] and [stroke], and for gears and strokes
// that monitor and tables have no room for.
[[nodiscard]] host::GrindingFile grinding_job(const host::MachineFile& machine);

// Swivelled by the helix angle, in to the root circle.
[[nodiscard]] WheelSetup form_wheel(const host::GrindingFile& job);

// Table 3 of the paper at the feed of its figures, which published and specified deviations are of.
[[nodiscard]] bool is_of_the_paper(const host::GrindingFile& job);

}  // namespace volcomp::internal_helical
