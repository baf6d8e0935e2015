// volcomp run internal-helical

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/run_experiment.hpp"
#include "host_sim/cli/shard_options.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/parts.hpp"
#include "host_sim/experiments/internal_helical/report.hpp"
#include "host_sim/host/tables/learned_files.hpp"

namespace volcomp::cli {
namespace {

struct InternalHelicalArguments : RunArguments {
  internal_helical::InternalHelicalOptions options;
  std::string table_folder;  // empty: none
  std::string shard;         // empty: all seeds
  bool noise_free = false;
};

// The learned tables and what is in them.
void add_tables(const std::string& folder, const internal_helical::InternalHelicalResult& run,
                RunOutcome& outcome) {
  for (const host::LearnedFile& file : host::learned_files(run.gear, run.detail.tables)) {
    outcome.files.push_back({file.name, file.text});
    outcome.file_lines += fmt::format(
        "table: {} ({})\n", (std::filesystem::path(folder) / file.name).string(), file.meaning);
  }
  outcome.folder = folder;
}

RunOutcome internal_helical_outcome(RunPlace& place, const InternalHelicalArguments& arguments,
                                    const host::Progress& progress) {
  internal_helical::InternalHelicalOptions options = arguments.options;
  options.machine = machine_of(arguments, "internal_grinder");
  options.make_axes = place.axes();
  options.watch = &place.watch();
  options.threads = place.threads();
  if (arguments.noise_free) options.truth.take_noise_away();
  if (!arguments.shard.empty()) options.shard = part_to_write(arguments, arguments.shard);
  const internal_helical::InternalHelicalResult run =
      internal_helical::run_internal_helical(options, progress);
  if (!arguments.shard.empty())
    return part_outcome(internal_helical::part_of_helical(run), options.shard);
  RunOutcome outcome;
  if (!arguments.table_folder.empty()) add_tables(arguments.table_folder, run, outcome);
  std::vector<std::string> names;
  for (const host::NamedText& file : outcome.files)
    names.push_back(file.name);
  outcome.summary = internal_helical::internal_helical_summary(run);
  outcome.document = internal_helical::internal_helical_document(run, place.context());
  outcome.figures = internal_helical::internal_helical_figures(run, names);
  outcome.good = internal_helical::internal_helical_verdict(run).ok;
  return outcome;
}

}  // namespace

void add_internal_helical_command(CLI::App& run, const std::string& command, int& code) {
  CLI::App* helical = run.add_subcommand(
      "internal-helical",
      "Internal helical gear: watch Z and C while it is ground, learn offsets of C, inspect it");
  auto a = std::make_shared<InternalHelicalArguments>();
  a->command = command;
  helical->add_option("--seeds", a->options.seeds, "Grinders to simulate; medians are over them")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  helical->add_flag("--noise-free", a->noise_free,
                    "Every pass repeats the one before, the measuring machine does not scatter: "
                    "what the mathematics alone can do");
  const auto word = [](internal_helical::LearningWay way) {
    return std::string(internal_helical::kLearningWays.at(static_cast<std::size_t>(way)));
  };
  const std::map<std::string, internal_helical::LearningWay> wrong{
      {word(internal_helical::LearningWay::c_alone), internal_helical::LearningWay::c_alone},
      {word(internal_helical::LearningWay::one_table), internal_helical::LearningWay::one_table},
      {word(internal_helical::LearningWay::coarse), internal_helical::LearningWay::coarse}};
  add_choice<internal_helical::LearningWay>(*helical, "--wrong", a->options.way, wrong,
                                            "Learn in a wrong way")
      ->default_str("");
  CLI::Option* tables = helical->add_option(
      "--tables", a->table_folder, "Folder for the learned tables as files of controllers");
  add_shard_option(*helical, a->shard)->excludes(tables);
  add_output_options(*helical, *a);
  add_can_option(*helical, a->node);
  CLI::Option* drives = add_drive_option(*helical, a->node);
  helical
      ->add_option("--log", a->node.log_file,
                   "Write all frames to this file, as candump -L does (-: standard output)")
      ->needs("--can");
  helical->callback([a, drives, &code] {
    require_node({drives}, a->node, "--can");
    code = run_experiment(*a, {}, internal_helical_outcome);
  });
}

}  // namespace volcomp::cli
