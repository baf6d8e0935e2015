#pragma once
// What was measured before and after compensation, as charts of a report.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/any_machine/verification.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::any_machine {

// Curves of a value over the number of the reading.
template <class Value>
nlohmann::json reading_series(const std::vector<PlaceReading>& before,
                              const std::vector<PlaceReading>& after, const Value& value) {
  const auto curve = [&](const char* name, const std::vector<PlaceReading>& readings) {
    std::vector<double> y(readings.size());
    std::transform(readings.begin(), readings.end(), y.begin(), value);
    return host::series_of(name, host::counted(y.size()), y);
  };
  return {curve("uncompensated", before), curve("compensated", after)};
}

// There must be readings.
[[nodiscard]] nlohmann::json line_charts(const MachineState& before, const MachineState& after);
[[nodiscard]] nlohmann::json sphere_chart(const SpherePlan& plan, const MachineState& before,
                                          const MachineState& after);
[[nodiscard]] nlohmann::json volume_chart(const host::MachineFile& machine,
                                          const MachineState& before, const MachineState& after);

}  // namespace volcomp::any_machine
