#pragma once
// Two measurements of the same squareness: what circles of a ball bar read, and what three lines
// through the same point read, differ by the form of the axes (docs/ball-bar.md).

#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::xyfz {

// a_xy, a_xz, a_yz; µrad.
using Planes = std::array<double, 3>;
inline constexpr std::array<const char*, 3> kPlaneNames{"XY", "XZ", "YZ"};

// A perfect bar on circles of kBallBar_mm less a perfect bar along the lines of the machine file.
struct CirclesLessLines {
  Planes all{};
  Planes without_angles{};  // of the same machine: positioning and straightness alone
  Planes angles{};          // pitch, yaw and roll alone
};
[[nodiscard]] CirclesLessLines circles_less_lines(const sim::TrueMachine& truth,
                                                  const host::MachineFile& file);

// A row a plane: root mean square, least and most over the machines.
[[nodiscard]] nlohmann::json functionals_table(const std::vector<CirclesLessLines>& machines);

// In a part of a run, and read back. Throws UserError.
[[nodiscard]] nlohmann::json functionals_json(const CirclesLessLines& machine);
[[nodiscard]] CirclesLessLines functionals_of(const nlohmann::json& machine);

}  // namespace volcomp::xyfz
