#pragma once
// A calibration of a probe as settings of a node (2302h, 2304h), for people and as JSON.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/probe_calibration.hpp"

namespace volcomp::host {

// An object of the node and the value that is meant for it.
struct NodeSetting {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::string name;  // as in the object dictionary
  double value = 0.0;
  std::string unit;
};

// All sixteen coefficients of 2302h, so that an older map is replaced, and the standard
// uncertainties of radius and touch of 2304h; nm.
[[nodiscard]] std::vector<NodeSetting> probe_settings(const ProbeCalibration& calibration);

// As TOML: one table [[setting]] with object, name, value and unit for each. `about`: one line, for
// the comment at the beginning.
[[nodiscard]] std::string settings_toml(const std::vector<NodeSetting>& settings,
                                        const std::string& about);

// "96 touches of a sphere of 25 mm diameter".
[[nodiscard]] std::string calibration_title(const ProbeCalibration& calibration,
                                            const ProbeArtefact& artefact);

[[nodiscard]] std::string calibration_text(const ProbeCalibration& calibration,
                                           const ProbeArtefact& artefact);

[[nodiscard]] nlohmann::json calibration_json(const ProbeCalibration& calibration,
                                              const ProbeArtefact& artefact);

}  // namespace volcomp::host
