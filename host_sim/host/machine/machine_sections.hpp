#pragma once
// The tables of a machine file that stand by themselves. A value outside its range throws UserError
// with file and line.

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Limits, rates and times of [correction].
void read_correction_values(const TomlSection& s, CorrectionFile& c);

// Fields of [[axis]] for its acceleration, and their values.
[[nodiscard]] const std::vector<std::string>& axis_acceleration_fields();
void read_axis_acceleration(const TomlSection& s, AxisFile& axis);
// Acceleration of the offsets of these axes from [correction] and what the axes state, which must
// be read.
void read_offset_acceleration(const TomlSection& correction, const std::vector<std::size_t>& axes,
                              MachineFile& machine);

[[nodiscard]] SquarenessFile read_squareness(const TomlSection& s);

// Needs the axes and the chain of the machine.
[[nodiscard]] ThermalFile read_thermal(const TomlSection& s, const MachineFile& machine);

[[nodiscard]] ProbeFile read_probe(const TomlSection& s);

[[nodiscard]] LaserFile read_laser(const TomlSection& s);

// [gear], [wheel] and [stroke] of the whole file.
[[nodiscard]] GrindingFile read_grinding(const TomlSection& top);

// Six numbers in mm and rad: where a body or an axis is and how it lies.
[[nodiscard]] ErrorMotion read_error(const TomlSection& s, const std::string& key);

// 0…1000; 0 where the field is missing.
[[nodiscard]] double read_delay_us(const TomlSection& s, const std::string& key);

}  // namespace volcomp::host
