#pragma once
// Observations as the tables that observation_table.hpp reads. Linear axes to 1 nm, rotary ones to
// 1e-9 degrees.

#include <string>
#include <vector>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

// Latched positions of one touch.
struct LatchedTouch {
  std::size_t setup = 0;
  std::size_t sphere = 0;
  std::size_t stylus = 0;
  Pose q{};
  Directions d{};
};
[[nodiscard]] std::string touches_csv(const MeasurementPlan& plan,
                                      const std::vector<LatchedTouch>& touches);

// A set-up of tracer, bar, diagonal, step or rtest with its readings.
[[nodiscard]] std::string readings_csv(const MeasurementPlan& plan, const SetUp& setup);

}  // namespace volcomp::host::identify
