#pragma once
// One [[setup]] of a measurement plan, with the observations of its file or, without one, with the
// positions that it would have.

#include "host_sim/host/measure/identify/plan_readings.hpp"

namespace volcomp::host::identify {

// Adds it to the plan, whose machine, styli and artefacts are there. Throws UserError.
void read_setup(MeasurementPlan& plan, const SetUpFiles& files, const TomlSection& s);

}  // namespace volcomp::host::identify
