#pragma once
// Exchange files of Etalon's measuring software, variant "Vendor": a block per parameter, comments
// after //.
//
//   [C0B]
//   VALUE = 0.0000223
//   [EXY]
//   Gridpoints = {
//     -280.0 -0.00136
//     -270.0 -0.00024
//   }
//
// Source: the section "Etalon Exchange Format" of the manuals of its readers, Beckhoff TF5280
// (infosys.beckhoff.com/content/1033/tf5280_volumetric_comp/296430091.html) and ISG
// (isg-stuttgart.de/fileadmin/kernel/kernel-html/en-GB/296430091.html); units as in isg_csv.hpp,
// which "apply to all file formats". Etalon's own description is not public: keys that the manuals
// do not show are refused, and the sign is an option.

#include "host_sim/host/tables/formats/foreign_errors.hpp"

namespace volcomp::host {

// Throws UserError with file and line.
void read_etalon(std::istream& stream, const std::string& name, ForeignErrors& errors);

}  // namespace volcomp::host
