#pragma once
// The touches of a plan as an NC program: standard words of RS274, touches by G38.2, pauses where
// an artefact or a tip has to be changed. Where the controller can (LinuxCNC), every latched
// position becomes a row of touches.csv, which `identify` reads.

#include <string>
#include <vector>

#include "host_sim/host/measure/identify/plan_file.hpp"

namespace volcomp::host::identify {

struct TouchProgram {
  std::string text;
  std::size_t touches = 0;
  // Spheres without room to approach them: "flat: sphere 3 with tip S1".
  std::vector<std::string> left_out;
};

// Of every sphere of the set-ups of kinds centre and touch. Coordinates are those of the machine
// file, mm and degrees. Throws UserError where there is no such set-up, a radius is missing, or a
// name cannot stand in a program.
[[nodiscard]] TouchProgram touch_program(const MeasurementPlan& plan);

}  // namespace volcomp::host::identify
