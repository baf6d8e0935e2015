#pragma once
// Run files that a command has written, for programs.

#include <nlohmann/json.hpp>

#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::cli {

// {"axis", "file", "unit" of the targets, "targets", "from", "to", "runs_up", "runs_down", "rows"}
[[nodiscard]] nlohmann::json run_file_json(const host::RunsFile& runs, const std::string& path);

// What is the same in all of them.
[[nodiscard]] nlohmann::json run_values_json();

}  // namespace volcomp::cli
