#pragma once
// What a plan will see, as text for people and as JSON, and its points for a controller.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/identify/plan_prediction.hpp"

namespace volcomp::host::identify {

// Tables and sentences, in the order of the text.
[[nodiscard]] nlohmann::json plan_prediction_sections(const MeasurementPlan& plan,
                                                      const PlanPrediction& predicted);
[[nodiscard]] std::string plan_prediction_text(const MeasurementPlan& plan,
                                               const PlanPrediction& predicted);
// Spheres named as a plan does, "flat: sphere 3 with tip S1": one line a set-up and tip.
[[nodiscard]] std::vector<std::string> spheres_by_tip(const std::vector<std::string>& spheres);
// Where the machine will stand for each observation, for the program of a controller:
// setup,kind,sphere,tip,X [mm],… ; of a sphere the place of the tip in its centre.
[[nodiscard]] std::string points_csv(const MeasurementPlan& plan);
[[nodiscard]] nlohmann::json plan_prediction_json(const MeasurementPlan& plan,
                                                  const PlanPrediction& predicted);

}  // namespace volcomp::host::identify
