#pragma once
// What a user is warned of when tables are built from runs, with the place in the file of runs.

#include <string>
#include <vector>

#include "comp/metrology/tables/table_builder.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

// Throws UserError for targets beyond the travel and for those of hardly any of it, which means a
// wrong unit; warns of travel without targets.
void check_targets(const RunsFile& runs, const AxisFile& axis, std::vector<std::string>& warnings);

// The warnings of the builder.
void note_warnings(const RunsFile& runs, const AxisFile& axis, const BuiltTable& built,
                   std::vector<std::string>& out);

// The slopes that the builder has removed, where no squareness puts them back.
void note_slopes(const RunsFile& runs, const AxisFile& axis, const BuiltTable& built,
                 std::vector<std::string>& out);

// Throws UserError with the line of the refused reading, or of the first one of its target or run.
void require_runs(const Status& status, const RunsFile& runs);

}  // namespace volcomp::host
