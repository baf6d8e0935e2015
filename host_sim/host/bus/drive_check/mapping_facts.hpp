#pragma once
// What is known of the mappings that a drive takes, in words.

#include <optional>
#include <string>

#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

// Whether the drive can take its target from the node: 6040h alone out of the frame of the
// controller, 607Ah in an RPDO of its own, 6061h in a TPDO. Nothing: only trying tells.
[[nodiscard]] std::optional<bool> may_be_forwarded(const ForeignDrive& drive);
// "yes: 6040h alone or with 0007h", "no: 607Ah in no RPDO".
[[nodiscard]] std::string forwarding_text(const ForeignDrive& drive);
// ", tried in RPDO4 and TPDO4", or empty.
[[nodiscard]] std::string trial_text(const ForeignDrive& drive);

}  // namespace volcomp::host
