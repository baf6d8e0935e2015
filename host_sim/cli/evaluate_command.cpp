// volcomp evaluate

#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/host/tables/evaluation_text.hpp"

namespace volcomp::cli {
namespace {

constexpr double kMostPosition = 1e6;

struct EvaluateArguments {
  std::string image;
  std::string machine;
  std::vector<std::string> runs;
  std::vector<std::string> at;
  std::optional<std::size_t> grid;
  std::string direction = "mean";
  std::string csv_file;
  std::string json_file;
};

struct EvaluatedTables {
  host::TableSource source;
  std::unique_ptr<MachineTables> tables;
};

EvaluatedTables tables_of_image(const EvaluateArguments& a) {
  host::TableImage image = host::read_table_image(a.image);
  if (!a.machine.empty())
    host::require_same_machine(*image.tables, image.name, host::read_machine_file(a.machine));
  return {{{image.name}, image.crc}, std::move(image.tables)};
}

EvaluatedTables tables_of_runs(const EvaluateArguments& a) {
  if (a.machine.empty() || a.runs.empty())
    throw host::UserError("nothing to evaluate: give an image, or --machine and --runs");
  EvaluatedTables made{{{a.machine}, {}}, nullptr};
  std::vector<host::RunsFile> runs;
  for (const std::string& path : a.runs) {
    runs.push_back(host::read_runs_file(path));
    made.source.files.push_back(path);
  }
  const auto built = host::build_tables(host::read_machine_file(a.machine), runs,
                                        host::tables_only(host::ModelKind::abbe_closed));
  made.tables = std::make_unique<MachineTables>(built->tables);
  return made;
}

std::string axis_letters(const MachineChain& chain) {
  std::string letters;
  for (std::size_t k = 0; k < chain.axis_count(); ++k)
    letters += fmt::format(" {}", chain.axis(k).letter);
  return letters;
}

// "X,Y,Z": mm of linear axes, degrees of rotary ones.
Pose position_from(const std::string& text, const MachineChain& chain) {
  std::vector<double> values;
  std::istringstream cells(text + ",");
  for (std::string cell; std::getline(cells, cell, ',');) {
    double value = 0.0;
    if (!CLI::detail::lexical_cast(cell, value) || !(std::abs(value) <= kMostPosition))
      throw host::UserError(
          fmt::format("--at {}: \"{}\" is not a number up to {:g}", text, cell, kMostPosition));
    values.push_back(value);
  }
  if (values.size() != chain.axis_count())
    throw host::UserError(fmt::format("--at {}: {} positions, the machine has the axes{}", text,
                                      values.size(), axis_letters(chain)));
  Pose q{};
  for (std::size_t k = 0; k < values.size(); ++k)
    q[k] = values[k] * (chain.axis(k).kind == JointKind::rotary ? kPi / 180.0 : 1.0);
  return q;
}

Travel travel_of(const std::string& direction) {
  if (direction == "up") return Travel::forward;
  return direction == "down" ? Travel::backward : Travel::unknown;
}

int evaluate(const EvaluateArguments& a) {
  if (a.at.empty() && !a.grid) throw host::UserError("no positions: give --at or --grid");
  std::vector<std::string> inputs = a.runs;
  inputs.insert(inputs.end(), {a.image, a.machine});
  Results results({a.csv_file, a.json_file}, std::move(inputs));
  const EvaluatedTables from = a.image.empty() ? tables_of_runs(a) : tables_of_image(a);
  host::TableEvaluator evaluator(*from.tables, from.source.files.front(), travel_of(a.direction));
  std::vector<Pose> positions;
  if (a.grid) positions = evaluator.grid(*a.grid);
  for (const std::string& text : a.at)
    positions.push_back(position_from(text, evaluator.chain()));
  const host::Evaluation evaluation = evaluator.evaluate(positions);
  const nlohmann::json facts = host::evaluation_json(evaluator, evaluation, from.source);
  results.add(a.csv_file, host::evaluation_csv(evaluator, facts));
  results.add(a.json_file, json_text(facts));
  results.write();
  fmt::print(results.text(), "{}", host::evaluation_text(evaluator, facts));
  return 0;
}

}  // namespace

void add_evaluate_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "evaluate", "Print the error that tables give at positions, and the offsets against it");
  auto a = std::make_shared<EvaluateArguments>();
  CLI::Option* image = command->add_option("IMAGE", a->image, "Table image (.vct)");
  command->add_option(
      "--machine", a->machine,
      "Machine file (TOML), with --runs; with an image: it must be of this machine");
  command->add_option("--runs", a->runs, "Run files (CSV), one per axis, instead of an image")
      ->excludes(image);
  command
      ->add_option("--at", a->at,
                   "Position of all axes in the order of the machine file, X,Y,Z for instance: mm, "
                   "degrees of rotary axes; may be given several times")
      ->allow_extra_args(false);
  command
      ->add_option("--grid", a->grid,
                   "So many positions for each axis, from end to end of its table, in all "
                   "combinations")
      ->check(CLI::Range(std::size_t{2}, host::TableEvaluator::kMostGridPoints));
  command
      ->add_option("--direction", a->direction,
                   "Direction in which all axes arrive: the table of this direction, or the mean "
                   "of both, as long as a node has seen no motion")
      ->check(CLI::IsMember({"up", "down", "mean"}))
      ->capture_default_str();
  command->add_option("--csv", a->csv_file,
                      "Write a row for each position to this file (-: standard output)");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->callback([a, &code] { code = evaluate(*a); });
}

}  // namespace volcomp::cli
