#pragma once
// What follows from a machine file: how well the correcting axes can correct over the travel, what
// no axis can, which errors every axis may carry, how large its tables are.

#include <string>
#include <vector>

#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Least value over a grid of the travels, where, and the greatest.
struct LeastAuthority {
  double value = 0.0;  // |det| of three unit directions, the sine of the angle of two, 1 of one
  Pose at{};           // mm, rad
  double greatest = 0.0;
};
// Authority of the correcting axes over a position error. Below kMinAuthority the run time does not
// correct.
[[nodiscard]] LeastAuthority least_authority(const MachineFile& machine);
// Throws UserError when they cannot correct anywhere.
void require_authority(const MachineFile& machine);

[[nodiscard]] std::vector<std::size_t> rotary_axes(const MachineChain& chain);
// Authority of these axes over the direction of the tool axis, Z of the tool frame: how much it
// turns in the worst direction, rad/rad. 0 where one direction is out of reach.
[[nodiscard]] LeastAuthority least_turning(const MachineFile& machine,
                                           const std::vector<std::size_t>& rotary);
// The axes that orient the tool, by the file.
[[nodiscard]] std::vector<std::size_t> orienting_axes(const MachineChain& chain);

// Names by ISO 230-1 of the six error motions of an axis, and of where it is and how it lies.
[[nodiscard]] std::vector<std::string> motion_errors(char letter);
[[nodiscard]] std::vector<std::string> location_errors(const Joint& joint);

// Bytes of the table image of this machine, at most `knots` a table.
[[nodiscard]] std::size_t table_bytes(const MachineFile& machine, std::size_t knots);

}  // namespace volcomp::host
