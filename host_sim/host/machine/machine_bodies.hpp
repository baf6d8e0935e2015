#pragma once
// The bodies of a machine file and how they hang on one another: a list [[body]], or a chain as one
// writes it down with the joints at the axes.

#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/machine/machine_file.hpp"

namespace volcomp::host {

// Fields of an [[axis]] that stand at its [[body]] when there is a list of those.
[[nodiscard]] const std::vector<std::string>& joint_fields();

// One of X Y Z A B C U V W. Throws UserError.
[[nodiscard]] char letter_of(const TomlSection& section, const std::string& key);

// Fills in bodies, work body and tool body of `d`, and the names of the bodies. The axes of `file`
// must have been read. Throws UserError.
void read_bodies(const TomlSection& top, MachineFile& file, MachineDescription& d);

}  // namespace volcomp::host
