#pragma once
// --shard of the scenarios that run in parts.

#include <string>

#include <CLI/CLI.hpp>

#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/report/draws_of_run.hpp"

namespace volcomp::cli {

CLI::Option* add_shard_option(CLI::App& scenario, std::string& shard);

// Throws UserError: not K/N, or nowhere to write the part to.
[[nodiscard]] host::Shard part_to_write(const RunArguments& arguments, const std::string& shard);

// `draws` as they were asked for, on all processors: all of them, or with a `shard` that part.
[[nodiscard]] host::DrawPlan plan_of_draws(const RunArguments& arguments, host::DrawPlan draws,
                                           const std::string& shard);

// The part as the figures of the run. It is good: there is no verdict without the other parts.
[[nodiscard]] RunOutcome part_outcome(const host::PartialRun& part, const host::Shard& shard);

}  // namespace volcomp::cli
