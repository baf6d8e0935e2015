#pragma once
// LinuxCNC screw compensation: lines `nominal forward reverse`. COMP_FILE_TYPE 0: both are
// positions, the trim is nominal − value; 1: both are trims. A trim is added to the motor command
// and taken out of the displayed feedback. Source: usrmotLoadComp() in src/emc/motion/usrmotintf.cc
// of LinuxCNC, which stops without a message at the first line that is not three numbers: here such
// a line is refused. docs/formats.md, "LinuxCNC".

#include <istream>
#include <string>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

inline constexpr std::size_t kLinuxcncEntries = 256;

struct LinuxcncComp {
  int type = 1;                 // COMP_FILE_TYPE
  std::vector<double> nominal;  // ascending, mm (degree for a rotary joint)
  std::vector<double> forward;  // t, added to the command, travelling up
  std::vector<double> reverse;
};

// Six decimals. Refused: bad_setting ("type"), length_mismatch, what check_offsets() and
// check_nominal() refuse.
Status write_linuxcnc(const LinuxcncComp& table, std::string& text);

// Throws UserError with file and line. Entry k stands in line k + 1.
[[nodiscard]] LinuxcncComp read_linuxcnc(std::istream& stream, const std::string& name, int type);

}  // namespace volcomp::host
