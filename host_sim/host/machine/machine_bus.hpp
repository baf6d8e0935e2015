#pragma once
// What a machine file says of the CAN bus: who has which node id, and in which units the drives
// count. Throws UserError.

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Fields of an [[axis]].
[[nodiscard]] const std::vector<std::string>& drive_fields();

// `number`: of the axis in the file, from 0. The travel must have been read.
[[nodiscard]] DriveFile read_drive(const TomlSection& s, const AxisFile& axis, std::size_t number);

// [bus], where there is one. Refuses a node id that two have.
void read_bus(const TomlSection& top, MachineFile& file);

}  // namespace volcomp::host
