#pragma once
// What a control makes of the table files that volcomp writes (docs/formats.md, "What is written"):
// the files are read back, and the offsets evaluated, in mm or rad.

#include <string>

#include "host_sim/host/tables/formats/isg_ssfk.hpp"
#include "host_sim/host/tables/formats/linuxcnc_comp.hpp"
#include "host_sim/host/tables/formats/siemens_cec.hpp"
#include "host_sim/host/tables/formats/siemens_enc_comp.hpp"

namespace volcomp::test {

// Throw host::UserError, with the line where there is one. The sign of a cross compensation is not
// in its file; SSFK: bilateral tables with setpoints.
[[nodiscard]] host::EncCompTable read_enc_comp(const std::string& text, bool rotary);
[[nodiscard]] host::CecTable read_cec(const std::string& text, bool rotary, int sign);
[[nodiscard]] host::SsfkTable read_ssfk(const std::string& text, bool rotary);

// t at a position (mm or degree); the ends are held. `travel` is +1 or −1; a cross compensation for
// one direction is 0 while the base axis travels the other way.
[[nodiscard]] double offset_at(const host::EncCompTable& table, double position);
[[nodiscard]] double offset_at(const host::CecTable& table, double position, int travel);
[[nodiscard]] double offset_at(const host::SsfkTable& table, double position, int travel);
[[nodiscard]] double offset_at(const host::LinuxcncComp& table, double position, int travel);

}  // namespace volcomp::test
