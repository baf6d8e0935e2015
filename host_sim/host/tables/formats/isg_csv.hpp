#pragma once
// Volumetric compensation of the ISG kernel and Beckhoff TwinCAT CNC, "ISG CSV format": a header of
// names, rows of numbers separated by blanks, comments after //, a line with # before another
// header.
//
//   X      EXX     EYX     EZX     EAX    EBX    ECX
//   0.0    0.020   0.010   0.070   0.0    4e-6   3e-6
//
// Source: Beckhoff, TF5280 TwinCAT 3 CNC Volumetric compensation, "ISG CSV format"
// (infosys.beckhoff.com/content/1033/tf5280_volumetric_comp/296429067.html) and "Units of measure"
// (the same manual of ISG, isg-stuttgart.de/fileadmin/kernel/kernel-html/en-GB/296426379.html):
// errors in mm and rad, positions of X Y Z in mm and of A B C in degrees.
//
// The manual does not define the sign (it has a parameter that negates, P-VOLC-00009) and the point
// that the errors hold for, so both are options.

#include "host_sim/host/tables/formats/foreign_errors.hpp"

namespace volcomp::host {

// Throws UserError with file and line. Refused although the format has it: errors that depend on
// more than their own axis; no table here holds them.
void read_isg_csv(std::istream& stream, const std::string& name, ForeignErrors& errors);

}  // namespace volcomp::host
