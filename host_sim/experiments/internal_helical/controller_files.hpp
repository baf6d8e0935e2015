#pragma once
// The learned tables as files of controllers that have a place for them. docs/formats.md, "What is
// written".

#include <string>
#include <vector>

#include "host_sim/experiments/internal_helical/grinder_control.hpp"

namespace volcomp::internal_helical {

struct ControllerFile {
  std::string name;
  std::string text;
  std::string meaning;
};

// T1 as cross compensation Z → C, one table per direction (Siemens); or, where a controller only
// corrects an axis by itself, as offset of Z that does the same to the flank, p times that of C
// (LinuxCNC, ISG). T2 as table of C around a turn (Siemens). Throws UserError.
[[nodiscard]] std::vector<ControllerFile> controller_files(const InternalGear& gear,
                                                           const LearnedTables& tables);

}  // namespace volcomp::internal_helical
