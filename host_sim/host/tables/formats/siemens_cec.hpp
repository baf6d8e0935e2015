#pragma once
// Siemens cross compensation $AN_CEC: a function of the setpoint of one axis, added to the setpoint
// of another. Two tables, one per direction of Z, with C as output are the stroke tables T1.
// docs/formats.md, "What is written".
//
// Machine data that go with it: MD18342 $MN_MM_CEC_MAX_POINTS[t], MD32710 $MA_CEC_ENABLE, SD41300
// $SN_CEC_TABLE_ENABLE[t]; limited by MD32720 and MD32730. The sign follows from "additional
// setpoint" and is the opposite of $AA_ENC_COMP: check it with one node of 10 µm and a dial gauge.

#include <string>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

struct CecTable {
  int number = 0;              // t
  std::string input;           // base axis, for instance "Z1"
  std::string output;          // for instance "C1"
  std::vector<double> offset;  // t, added to the command of `output`; mm, or rad if `rotary`
  double min = 0.0;            // of the base axis, mm or degree
  double step = 1.0;
  int direction = 0;    // +1 or −1: while the base axis travels that way; 0: both
  bool modulo = false;  // of the base axis: first = last
  bool rotary = false;  // the output axis
  int sign = 1;         // −1 where the dial gauge shows so
};

// Six decimals. Refused: bad_setting (field), what check_offsets() refuses.
Status write_cec(const CecTable& table, std::string& text);

}  // namespace volcomp::host
