#pragma once
// Touches of spheres as observations of a set-up: their centres, or each touch alone.

#include <string>
#include <vector>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

struct TipTouch {
  std::size_t line = 0;
  std::size_t sphere = 0;
  std::size_t stylus = 0;
  Pose q{};
  Directions d{};
};

// `sigma`: of one touch, mm. Touches of a sphere with one tip at one rotary position belong
// together, wherever they stand. Throws UserError naming `file`.
void add_centres(MeasurementPlan& plan, const std::string& file,
                 const std::vector<TipTouch>& touches, double sigma, SetUp& setup);
void add_single_touches(const std::vector<TipTouch>& touches, double sigma, SetUp& setup);

}  // namespace volcomp::host::identify
