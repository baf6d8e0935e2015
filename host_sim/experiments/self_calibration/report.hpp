#pragma once

#include <nlohmann/json.hpp>

#include "host_sim/experiments/self_calibration/scenario.hpp"
#include "host_sim/host/report/document.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::self_calibration {

// A run as a report document (host_sim/host/report/page/README.md), and the same for a terminal.
[[nodiscard]] nlohmann::json document(const Result& result, const host::RunContext& run);
[[nodiscard]] std::string summary(const Result& result);

// What every run of a plan is made of, for one run or many.
[[nodiscard]] host::Origins origins(const Options& options,
                                    const host::identify::MeasurementPlan& plan,
                                    const std::vector<host::HashedInput>& inputs);

}  // namespace volcomp::self_calibration
