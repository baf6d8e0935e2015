#pragma once
// A measurement plan, plan.toml: the machine, what of its errors is asked, styli, artefacts, and
// set-ups with the files of their observations (docs/identification.md).

#include <filesystem>
#include <map>
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
  bool commanded = false;    // positions are those commanded, not those of the encoders
  std::string active_image;  // CRC-32 of the tables that were at work; empty: none
  std::vector<std::filesystem::path> files;
  // By set-up of kind centre, by observation.
  std::vector<std::vector<TouchedSphere>> touched;
  // By set-up: name of its file in the plan, and σ of one touch, mm; empty and 0 where it has none.
  std::vector<std::string> file_of;
  std::vector<double> touch_sigma;
  // Set-ups whose file was not there.
  std::vector<std::string> lacking;
  // Spheres out of reach, left out of a plan: "placement 3: sphere 7 with tip S1".
  std::vector<std::string> unreached;

  [[nodiscard]] bool has_readings() const;  // of every set-up
};

// Where the readings of a plan come from.
struct PlanFiles {
  std::map<std::string, std::string> text = {};  // by name in the plan: instead of such a file
  bool may_lack = false;                         // what has no file is planned at usual places
};

// Throws UserError with file and line.
[[nodiscard]] MeasurementPlan read_plan(const std::filesystem::path& path,
                                        const PlanFiles& files = {});

// Plans that come with the program, by name; VOLCOMP_PLANS names another folder.
[[nodiscard]] std::vector<std::string> bundled_plans();
[[nodiscard]] std::filesystem::path bundled_plan(const std::string& name);

}  // namespace volcomp::host::identify
