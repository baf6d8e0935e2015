#pragma once
// Touches of spheres as observations of a set-up: their centres, each touch alone, or, before
// anything is measured, the centres that a plan would find.

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

// Every sphere with every tip, the rotary axes at their references; what is out of reach is named
// in the plan. Throws UserError where the set-up has no pose.
void add_planned_spheres(MeasurementPlan& plan, const std::vector<std::size_t>& tips, double sigma,
                         SetUp& setup);

}  // namespace volcomp::host::identify
