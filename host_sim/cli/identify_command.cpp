// volcomp identify, volcomp plan

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/progress_bar.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/measure/identify/identified_document.hpp"
#include "host_sim/host/measure/identify/identified_report.hpp"
#include "host_sim/host/measure/identify/plan_document.hpp"
#include "host_sim/host/measure/identify/plan_report.hpp"
#include "host_sim/host/measure/identify/touch_program.hpp"

namespace volcomp::cli {
namespace {

using namespace host::identify;

struct IdentifyArguments {
  std::string plan;
  std::string image_file;
  std::string json_file;
  std::string csv_file;
  std::string report_folder;
  std::string command;
  IdentifySettings settings;
  bool no_leave_out = false;
};

void print_report_place(const Results& results, const std::string& folder) {
  if (!folder.empty()) fmt::print(results.text(), "report: {}\n", report_page(folder));
}

std::vector<std::string> inputs_of(const MeasurementPlan& plan) {
  std::vector<std::string> inputs{plan.path, plan.machine.path};
  for (const auto& file : plan.files)
    inputs.push_back(file.string());
  return inputs;
}

host::Origins origins_of(const MeasurementPlan& plan) {
  host::Origins origins;
  host::add_origin(origins, "plan", plan.path);
  host::add_origin(origins, "machine file", plan.machine.path);
  std::set<std::filesystem::path> added;
  for (const std::filesystem::path& file : plan.files)
    if (std::filesystem::exists(file) && added.insert(file).second)
      host::add_origin(origins, "readings", file.string());
  return origins;
}

int identify_machine(const IdentifyArguments& a) {
  const MeasurementPlan plan = read_plan(a.plan);
  Results results(with_report({a.image_file, a.json_file, a.csv_file}, a.report_folder),
                  inputs_of(plan), a.report_folder);
  if (!plan.has_readings())
    throw host::UserError(fmt::format(
        "{}: not every set-up has readings; volcomp plan says what it will see", plan.path));
  IdentifySettings settings = a.settings;
  settings.leave_out = !a.no_leave_out;
  const Identified found = [&] {
    ProgressBar bar;
    return identify(plan, settings,
                    [&](double done, const std::string& what) { bar.show(done, what); });
  }();
  const std::vector<std::uint8_t> image = host::make_image(found.tables->tables);
  results.add(a.image_file, {reinterpret_cast<const char*>(image.data()), image.size()});
  results.add(a.json_file, json_text(identified_json(plan, found)));
  results.add(a.csv_file, functions_csv(plan, found.functions));
  if (!a.report_folder.empty())
    add_report(results, a.report_folder,
               identified_document(plan, found, {a.command, {}}, origins_of(plan)));
  results.write();
  fmt::print(results.text(), "{}", identified_text(plan, found));
  print_report_place(results, a.report_folder);
  return number(found.consistency.good() ? ExitCode::done : ExitCode::negative);
}

struct PlanArguments {
  std::string plan;
  std::string example;
  std::string points_file;
  std::string program_file;
  std::string json_file;
  std::string report_folder;
  std::string command;
};

// The machine file of the printed plan is beside it.
int print_example(const std::string& name) {
  constexpr std::size_t kLargest = std::size_t{1} << 20U;
  constexpr std::string_view kFolder = "../machines/";
  const std::vector<std::string> names = bundled_plans();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw host::UserError(
        fmt::format("there is no plan \"{}\"; the plans are: {}", name, fmt::join(names, ", ")));
  std::string text = host::read_whole_file(bundled_plan(name), kLargest);
  if (const std::size_t at = text.find(kFolder); at != std::string::npos)
    text.erase(at, kFolder.size());
  fmt::print("{}", text);
  return number(ExitCode::done);
}

void print_program(std::FILE* text, const TouchProgram& program) {
  fmt::print(text, "program: {} touches\n", program.touches);
  for (const std::string& spheres : spheres_by_tip(program.left_out))
    fmt::print(text, "not in the program, travels or other balls leave no room: {}\n", spheres);
}

int predict(const PlanArguments& a) {
  const MeasurementPlan plan = read_plan(a.plan, {{}, true});
  Results results(with_report({a.json_file, a.points_file, a.program_file}, a.report_folder),
                  inputs_of(plan), a.report_folder);
  std::optional<TouchProgram> program;
  if (!a.program_file.empty()) program = touch_program(plan);
  const PlanPrediction predicted = [&] {
    ProgressBar bar;
    return predict_plan(plan, [&](double done, const std::string& what) { bar.show(done, what); });
  }();
  results.add(a.json_file, json_text(plan_prediction_json(plan, predicted)));
  results.add(a.points_file, points_csv(plan));
  if (program) results.add(a.program_file, program->text);
  if (!a.report_folder.empty())
    add_report(results, a.report_folder,
               plan_document(plan, predicted, {a.command, {}}, origins_of(plan)));
  results.write();
  fmt::print(results.text(), "{}", plan_prediction_text(plan, predicted));
  if (program) print_program(results.text(), *program);
  print_report_place(results, a.report_folder);
  return number(predicted.solvable ? ExitCode::done : ExitCode::negative);
}

}  // namespace

void add_identify_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command = app.add_subcommand(
      "identify",
      "Errors of a machine from what a shop can measure: tracers, ball bars, diagonals, touched "
      "spheres, R-tests and runs, all together, with their uncertainty");
  auto a = std::make_shared<IdentifyArguments>();
  a->command = command_line(argc, argv);
  command->add_option("PLAN", a->plan, "Measurement plan (TOML) with the files of its readings")
      ->required();
  command->add_option("-o,--out", a->image_file, "Write a table image to this file");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->add_option("--csv", a->csv_file,
                      "Write the error functions to this file (-: standard output)");
  command->add_option("--report", a->report_folder, "Write report.html and report.json here");
  command->add_flag("--robust", a->settings.robust,
                    "Readings far off count less (Huber); they are named, never dropped");
  command->add_flag("--no-leave-out", a->no_leave_out,
                    "Do not hold every set-up against the others: faster");
  command->callback([a, &code] { code = identify_machine(*a); });
}

void add_plan_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* command = app.add_subcommand(
      "plan",
      "What a measurement plan will see before anything is measured: what stays unseen, the "
      "uncertainty of every error, and which set-up adds most");
  auto a = std::make_shared<PlanArguments>();
  a->command = command_line(argc, argv);
  CLI::Option* plan = command->add_option("PLAN", a->plan, "Measurement plan (TOML)");
  CLI::Option* example =
      command->add_option("--example", a->example,
                          "Print a plan that comes with the program, to begin with: every_kind, "
                          "trunnion_touch, xyfz_touch, ... Its machine file lies beside it "
                          "(volcomp machine example)");
  example->excludes(plan);
  command->add_option("--points", a->points_file,
                      "Write where the machine will stand for every observation to this file (-: "
                      "standard output)");
  command->add_option("--program", a->program_file,
                      "Write an NC program that touches every sphere of the plan five times to "
                      "this file (-: standard output)");
  command->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  command->add_option("--report", a->report_folder, "Write report.html and report.json here");
  command->callback([a, &code] {
    if (a->plan.empty() && a->example.empty()) throw CLI::RequiredError("PLAN or --example");
    code = a->example.empty() ? predict(*a) : print_example(a->example);
  });
}

}  // namespace volcomp::cli
