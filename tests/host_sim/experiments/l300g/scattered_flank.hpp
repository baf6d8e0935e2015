#pragma once
// A flank of the master gear as a probe that scatters finds it. No machine and no bus: nominal
// points, the gear's own deviation, noise along the normal, and the product's filter and figures.

#include <cstdint>
#include <vector>

#include "host_sim/experiments/l300g/inspection_plan.hpp"
#include "host_sim/experiments/l300g/truth.hpp"
#include "host_sim/host/measure/gear_traces.hpp"

namespace volcomp::l300g {

// Standard normal; `trace`: of a draw.
[[nodiscard]] double touch_noise(std::uint32_t draw, std::uint32_t trace, std::uint32_t touch);

enum class Traced : std::uint8_t { profile, lead };

struct Touching {
  double sigma_um = 0.0;    // of a touch
  std::size_t touches = 1;  // of a point, whose mean counts
  std::size_t points = 101;
  bool filter = false;
  std::size_t teeth = 1;
};

// Total deviations, µm.
struct FoundTotals {
  std::vector<double> tooth;  // of each
  // Of the mean trace of the first tooth, of the first two, and so on.
  std::vector<double> mean_trace;
};

class ScatteredFlank {
 public:
  ScatteredFlank(Traced what, const Touching& how);

  [[nodiscard]] FoundTotals measured(std::uint32_t draw) const;
  [[nodiscard]] bool has_grade_4(double total_um) const;

 private:
  void find_filter();
  [[nodiscard]] std::vector<double> touched(std::uint32_t draw, std::uint32_t tooth) const;
  [[nodiscard]] std::vector<double> evaluated(const std::vector<double>& touched) const;
  [[nodiscard]] double total(const std::vector<double>& deviation) const;

  Traced what_;
  Touching how_;
  InvoluteGear gear_ = master_gear();
  EvaluationRange range_;
  std::vector<double> at_;   // mm
  std::vector<double> own_;  // µm
  // What is left of one micrometre at each point, at all points; empty: no filter.
  std::vector<std::vector<double>> filter_;
};

}  // namespace volcomp::l300g
