#include "host_sim/cli/shard_options.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {

CLI::Option* add_shard_option(CLI::App& scenario, std::string& shard) {
  return scenario
      .add_option("--shard", shard,
                  "Compute part K of N and write it to --json, for volcomp collect")
      ->type_name("K/N");
}

host::Shard part_to_write(const RunArguments& arguments, const std::string& shard) {
  const host::Shard part = host::parse_shard(shard);
  if (arguments.json_file.empty()) throw host::UserError("--shard: give --json FILE for the part");
  if (!arguments.report_folder.empty())
    throw host::UserError("--shard: a report needs the whole run");
  if (arguments.live.port) throw host::UserError("--shard: a page needs the whole run");
  return part;
}

host::DrawPlan plan_of_draws(const RunArguments& arguments, host::DrawPlan draws,
                             const std::string& shard) {
  if (!shard.empty()) draws.shard = part_to_write(arguments, shard);
  draws.threads = host::processors();
  return draws;
}

RunOutcome part_outcome(const host::PartialRun& part, const host::Shard& shard) {
  return {fmt::format("part {} of {}: {} of {} draws\n", shard.number, shard.of, part.draw.size(),
                      part.draws),
          nlohmann::json::object(), host::partial_json(part, shard), true};
}

}  // namespace volcomp::cli
