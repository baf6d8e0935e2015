#pragma once
// Where the rotary axes of a simulated machine are: found with a tracking interferometer at four
// stations on the workpiece side, after the axes and their squareness have been measured. It
// follows the tool point wherever the axes take it: an R-test (ISO 10791-6, BK) would need three
// linear axes that follow a ball, which not every machine has.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "comp/metrology/tables/volumetric_model.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/average_line.hpp"

namespace volcomp::sim {

struct LocationSurvey {
  bool perfect = false;  // instrument and machine repeat, and nothing grows
  std::uint64_t seed = 1;
};

// A location error (EX0C, fixed side), or a constant of an axis with the tool (EX1B, moving side):
// body value, mm or rad.
struct LocationValue {
  std::string name;
  bool angular = false;
  double found = 0.0;
  double u = 0.0;  // standard uncertainty from instrument and repeatability alone
};

struct RotaryLocations {
  std::vector<LocationValue> found;
  // What no place of the tool shows: as the machine file has it.
  std::vector<std::string> assumed;
  std::array<AverageLine, kMaxAxes> place;  // by NC axis: what was found
  // What is left of the readings over their standard uncertainty: beyond 1 where the axes are not
  // as their runs have them.
  double misfit = 0.0;
};

// `known`: the tables made of the runs, with nothing of the locations. The squareness of the
// machine is in both. Throws UserError where nothing can be found.
[[nodiscard]] RotaryLocations locate_rotary_axes(const TrueMachine& truth,
                                                 const host::MachineFile& file,
                                                 const VolumetricModel& known,
                                                 const LocationSurvey& survey);

}  // namespace volcomp::sim
