#pragma once
// A measurement plan, plan.toml: the machine, what of its errors is asked, styli, artefacts, and
// set-ups with the files of their observations (docs/identification.md).

#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

// Touches of one sphere, from which an observation of its centre came.
struct TouchedSphere {
  std::vector<Pose> q;
  std::vector<Directions> d;
};

struct MeasurementPlan {
  std::string path;
  MachineFile machine;
  Problem problem;
  double temperature_C = 20.0;
  bool commanded = false;  // positions are those commanded, not those of the encoders
  std::vector<std::filesystem::path> files;
  // By set-up of kind centre, by observation.
  std::vector<std::vector<TouchedSphere>> touched;
  // Spheres out of reach, left out of a plan: "placement 3: sphere 7 with tip S1".
  std::vector<std::string> unreached;

  [[nodiscard]] bool has_readings() const;  // of every set-up
};

// Throws UserError with file and line.
[[nodiscard]] MeasurementPlan read_plan(const std::filesystem::path& path);

}  // namespace volcomp::host::identify
