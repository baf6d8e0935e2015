#pragma once
// Spindle pitch error compensation of the ISG kernel and Beckhoff TwinCAT CNC (kw.ssfk). Entries
// are actual − setpoint = −offset, integers of 0.1 µm or 0.0001 degree, one column per direction.
// Enabled by lr_param.ssfk (P-AXIS-00175). docs/formats.md, "What is written".

#include <string>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

struct SsfkTable {
  int axis_number = 1;          // kopf.log_achs_nr
  std::string axis;             // kopf.log_achs_name
  std::vector<double> nominal;  // ascending, mm or degree
  std::vector<double> forward;  // t, added to the command, travelling up; mm or rad
  std::vector<double> reverse;
  bool rotary = false;
};

// Entries and setpoints are integers of 32 bits. Refused: bad_setting ("axis"), length_mismatch,
// what check_offsets() and check_nominal() refuse.
Status write_ssfk(const SsfkTable& table, std::string& text);

}  // namespace volcomp::host
