// volcomp compare

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/flank_comparison.hpp"

namespace volcomp::cli {
namespace {

struct CompareArguments {
  host::CompareOptions options;
  std::vector<std::string> names;
  std::string plus = "metal";
  std::string row_1 = "tip";
  std::string column_1 = "inner";
  std::string unit = "um";
  std::string zero = "as-given";
  std::vector<std::size_t> rows{kProfileRows.first + 1, kProfileRows.last + 1};
  double limit = 0.0;
  bool has_limit = false;
  std::string json_file;      // empty: none
  std::string report_folder;  // empty: none
  std::string command;        // as the user has typed it
};

host::CompareOptions options_of(const CompareArguments& a) {
  host::CompareOptions options = a.options;
  if (!a.names.empty()) options.names = {a.names.at(0), a.names.at(1)};
  options.plus_is_metal = a.plus == "metal";
  options.row_1_is_tip = a.row_1 == "tip";
  options.column_1_is_inner = a.column_1 == "inner";
  options.um_per_unit = a.unit == "mm" ? 1e3 : 1.0;
  options.zeroing = a.zero == "centre" ? host::Zeroing::centre
                    : a.zero == "mean" ? host::Zeroing::mean
                                       : host::Zeroing::as_given;
  if (a.rows.at(0) > a.rows.at(1))
    throw host::UserError(
        fmt::format("--rows {} {}: the first row comes first", a.rows[0], a.rows[1]));
  options.profile_rows = {a.rows.at(0) - 1, a.rows.at(1) - 1};
  if (a.has_limit) options.limit_um = a.limit;
  return options;
}

std::vector<std::string> inputs_of(const CompareArguments& a) {
  std::vector<std::string> inputs = a.options.files;
  inputs.push_back(a.options.gear);
  return inputs;
}

int compare(const CompareArguments& a) {
  Results results(with_report({a.json_file}, a.report_folder), inputs_of(a), a.report_folder);
  const host::FlankComparison result = host::compare_flanks(options_of(a));
  if (!a.report_folder.empty())
    add_report(results, a.report_folder, host::comparison_document(result, {a.command, {}}));
  results.add(a.json_file, json_text(host::comparison_json(result)));
  results.write();
  fmt::print(results.text(), "{}", host::comparison_text(result));
  return result.within_limit() ? 0 : 1;
}

void add_choices(CLI::App& command, CompareArguments& a) {
  const auto choice = [&](const char* name, std::string& value,
                          const std::vector<std::string>& words, const char* what) {
    command.add_option(name, value, what)->check(CLI::IsMember(words))->capture_default_str();
  };
  choice("--plus-is", a.plus, {"metal", "space"},
         "What a positive value of the maps means: excess material or a lack of it");
  choice("--row-1", a.row_1, {"tip", "root"}, "Where row 1 of the maps is");
  choice("--column-1", a.column_1, {"inner", "outer"}, "Where column 1 of the maps is");
  choice("--unit", a.unit, {"um", "mm"}, "Unit of the maps");
  choice("--zero", a.zero, {"as-given", "centre", "mean"},
         "Take the value at row 4, column 8, or the mean from each map first");
  command
      .add_option("--left-is", a.options.left_side,
                  "Side of the slot that the left flank is on: +1 (y > 0) or -1")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str();
}

}  // namespace

void add_compare_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command = app.add_subcommand(
      "compare", "Compare two measurements of a face gear: error maps of 7 rows and 15 columns");
  auto a = std::make_shared<CompareArguments>();
  a->command = command_line(argc, argv);
  command
      ->add_option("MAPS", a->options.files,
                   "CSV files: first and second measurement of one (the left) flank, then of the "
                   "right one; an empty cell is one that was not measured")
      ->required()
      ->expected(2, 4);
  command->add_option("--names", a->names, "What to call the two measurements")->expected(2);
  command
      ->add_option("--gear", a->options.gear,
                   "Whose flanks, for how much of the difference is a frame: table1 or table3 of "
                   "the paper, a TOML file, or \"\" to leave it out")
      ->capture_default_str();
  add_choices(*command, *a);
  command->add_option("--rows", a->rows, "First and last row of the profile deviation")
      ->expected(2)
      ->check(CLI::Range(std::size_t{1}, kGridRows))
      ->capture_default_str();
  CLI::Option* limit =
      command
          ->add_option("--limit", a->limit, "Largest difference allowed, µm: beyond it exit code 1")
          ->check(number_between(0.0, 1e6));
  command->add_option("--json", a->json_file,
                      "Write the figures to this file (-: standard output)");
  command->add_option(
      "--report", a->report_folder,
      "Write report.html and report.json, with pictures of the maps, to this folder");
  command->callback([a, limit, &code] {
    a->has_limit = limit->count() > 0;
    code = compare(*a);
  });
}

}  // namespace volcomp::cli
