#pragma once
// Siemens encoder compensation $AA_ENC_COMP (leadscrew and measuring system error). It changes the
// actual value, so a positive entry moves the axis negative: entry = −offset. One table for both
// directions. docs/formats.md, "What is written".
//
// Machine data that go with it: MD38000 $MA_MM_ENC_COMP_MAX_POINTS at least the number of entries,
// MD32700 $MA_ENC_COMP_ENABLE[0] = 1; the axis must be referenced. The control does not limit it.

#include <string>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

struct EncCompTable {
  std::string axis;            // machine axis, for instance "Z1"
  std::vector<double> offset;  // t, added to the command, at min + k·step; mm or rad
  double min = 0.0;            // mm or degree
  double step = 1.0;           // mm or degree, > 0
  bool modulo = false;         // wraps: first = last
  bool rotary = false;
};

// Six decimals: 1 nm or 1e-6 degree. Refused: bad_setting ("axis", "step", "min"), what
// check_offsets() refuses; `text` is then unchanged.
Status write_enc_comp(const EncCompTable& table, std::string& text);

}  // namespace volcomp::host
