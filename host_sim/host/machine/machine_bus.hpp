#pragma once
// Reads the CAN bus of a machine file: node ids and units of the drives. Throws UserError.

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Rates of SYNC that a node keeps up with.
inline constexpr double kLeastCycle_hz = 50.0;
inline constexpr double kMostCycle_hz = 1000.0;

// As in the file.
[[nodiscard]] const char* word_of_way(Way way);

// Position units of the drive of a rotary axis in a turn.
[[nodiscard]] double units_per_turn(const DriveFile& drive);

// Fields of an [[axis]].
[[nodiscard]] const std::vector<std::string>& drive_fields();

// `number`: of the axis in the file, from 0. The travel must have been read.
[[nodiscard]] DriveFile read_drive(const TomlSection& s, const AxisFile& axis, std::size_t number);

// [bus], where there is one. Refuses a node id that two have.
void read_bus(const TomlSection& top, MachineFile& file);

}  // namespace volcomp::host
