#pragma once
// The learned tables as files of controllers that have a place for them. docs/formats.md, "What is
// written".

#include <string>
#include <vector>

#include "comp/metrology/gears/internal_gear.hpp"
#include "host_sim/host/tables/learned_tables.hpp"

namespace volcomp::host {

struct LearnedFile {
  std::string name;
  std::string text;
  std::string meaning;
};

// T1 as cross compensation Z → C, one table per direction (Siemens); or, where a controller only
// corrects an axis by itself, as offset of Z that does the same to the flank, p times that of C
// (LinuxCNC, ISG). T2 as table of C around a turn (Siemens). Throws UserError.
[[nodiscard]] std::vector<LearnedFile> learned_files(const InternalGear& gear,
                                                     const LearnedTables& tables);

}  // namespace volcomp::host
