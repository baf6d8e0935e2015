// volcomp run internal-helical

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/experiments/internal_helical/controller_files.hpp"
#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/report.hpp"

namespace volcomp::cli {
namespace {

struct InternalHelicalArguments : RunArguments {
  internal_helical::InternalHelicalOptions options;
  std::string table_folder;  // empty: none
};

std::vector<std::string> add_tables(const std::string& folder,
                                    const internal_helical::InternalHelicalResult& run,
                                    Results& results) {
  std::vector<std::string> names;
  if (folder.empty()) return names;
  std::vector<host::NamedText> files;
  for (const internal_helical::ControllerFile& file :
       internal_helical::controller_files(run.gear, run.detail.tables)) {
    files.push_back({file.name, file.text});
    fmt::print(results.text(), "table: {} ({})\n",
               (std::filesystem::path(folder) / file.name).string(), file.meaning);
    names.push_back(file.name);
  }
  results.add_files(folder, files);
  return names;
}

int run_internal_helical_command(const InternalHelicalArguments& arguments) {
  internal_helical::InternalHelicalOptions options = arguments.options;
  options.machine = machine_of(arguments, "internal_grinder");
  Results results = run_results(arguments);
  const std::unique_ptr<RunView> view = run_view(arguments, results);
  options.watch = view.get();
  std::unique_ptr<ScenarioBus> bus;
  if (!arguments.node.integrated()) {
    bus = std::make_unique<ScenarioBus>(arguments.node, view.get());
    options.make_axes = bus->axes();
  }
  const internal_helical::InternalHelicalResult run =
      run_watched(*view, bus.get(), [&options](const host::Progress& progress) {
        return internal_helical::run_internal_helical(options, progress);
      });
  fmt::print(results.text(), "{}transport: {}\n", internal_helical::internal_helical_summary(run),
             describe(arguments.node));
  const std::vector<std::string> tables = add_tables(arguments.table_folder, run, results);
  const nlohmann::json document =
      internal_helical::internal_helical_document(run, run_context(arguments, *view));
  write_results(arguments, document, internal_helical::internal_helical_figures(run, tables),
                results);
  view->ended(document);
  return internal_helical::internal_helical_verdict(run).ok ? 0 : 1;
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
  helical->add_option("--tables", a->table_folder,
                      "Folder for the learned tables as files of controllers");
  add_output_options(*helical, *a);
  helical->add_option(
      "--can", a->node.can,
      fmt::format("Compensate by a node on a CAN bus: loopback (in this process), {}",
                  host::kLinkForms));
  helical
      ->add_option("--log", a->node.log_file,
                   "Write all frames to this file, as candump -L does (-: standard output)")
      ->needs("--can");
  helical->callback([a, &code] { code = run_internal_helical_command(*a); });
}

}  // namespace volcomp::cli
