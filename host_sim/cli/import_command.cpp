// volcomp import

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/core/units.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_files.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/tables/formats/etalon_text.hpp"
#include "host_sim/host/tables/formats/foreign_errors.hpp"
#include "host_sim/host/tables/formats/isg_csv.hpp"
#include "host_sim/host/tables/formats/linuxcnc_comp.hpp"

namespace volcomp::cli {
namespace {

struct ImportArguments {
  std::vector<std::string> files;
  std::string sign;
  std::string absent;
  std::string out;
  std::string json_file;
  // LinuxCNC
  std::string axis;
  std::string unit;
  int type = -1;
};

std::string joined_names(const std::vector<std::string>& files) {
  std::string names;
  for (const std::string& file : files)
    names += (names.empty() ? "" : ", ") + host::shown_name(file);
  return names;
}

struct Imported {
  std::vector<host::RunsFile> runs;
  std::string locations;      // CSV; empty: there are none
  std::string origin;         // heads each file as a comment
  nlohmann::json convention;  // of the source
};

std::vector<host::NamedText> files_of(const Imported& imported) {
  const std::string head = "# " + imported.origin + "\n";
  std::vector<host::NamedText> files;
  for (const host::RunsFile& run : imported.runs)
    files.push_back({fmt::format("runs_{}.csv", run.letter), head + host::runs_csv(run)});
  if (!imported.locations.empty())
    files.push_back({"location_errors.csv", head + imported.locations});
  return files;
}

std::string written_text(const ImportArguments& a, const Imported& imported,
                         const std::vector<host::NamedText>& files) {
  std::string text;
  for (std::size_t i = 0; i < files.size(); ++i) {
    text += fmt::format("{}/{}", a.out, files[i].name);
    if (i < imported.runs.size()) {
      const host::RunsFile& runs = imported.runs[i];
      text += fmt::format(": axis {}, {} positions, {}", runs.letter, runs.positions.size(),
                          runs.down.empty() ? "one direction" : "both directions");
    }
    text += "\n";
  }
  if (!imported.locations.empty())
    text += "location errors are not part of run files: see [squareness] of the machine file\n";
  return text +
         "values are actual - nominal, mm and rad; convention, side, sensed point and reference "
         "are "
         "said by the machine file\n";
}

nlohmann::json written_json(const ImportArguments& a, const Imported& imported,
                            const std::vector<host::NamedText>& files) {
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t i = 0; i < imported.runs.size(); ++i)
    axes.push_back(run_file_json(imported.runs[i], a.out + "/" + files[i].name));
  nlohmann::json location;
  if (!imported.locations.empty()) location = a.out + "/" + files.back().name;
  return {
      {"sources", a.files},
      {"source_convention", imported.convention},
      {"absent_channels", a.absent.empty() ? nlohmann::json(nullptr) : nlohmann::json(a.absent)},
      {"folder", a.out},
      {"values", run_values_json()},
      {"axes", axes},
      {"location_errors", location}};
}

using ReadForeign = void (*)(std::istream&, const std::string&, host::ForeignErrors&);

template <class Read>
int import_with(const ImportArguments& a, const Read& read) {
  Results results({a.json_file}, a.files, a.out);
  const Imported imported = read();
  const std::vector<host::NamedText> files = files_of(imported);
  results.add_files(a.out, files);
  results.add(a.json_file, json_text(written_json(a, imported, files)));
  results.write();
  fmt::print(results.text(), "{}", written_text(a, imported, files));
  return 0;
}

Imported import_errors(const ImportArguments& a, ReadForeign read) {
  host::ForeignErrors errors;
  for (const std::string& path : a.files) {
    host::InputFile file(path);
    read(file.stream(), file.name(), errors);
  }
  host::ImportRules rules;
  rules.sign = a.sign == "actual-minus-nominal" ? 1 : -1;
  rules.absent_zero = a.absent == "zero";
  return {host::to_runs(errors, joined_names(a.files), rules),
          host::locations_csv(errors, rules),
          fmt::format("imported, values of the source are {}{}", a.sign,
                      rules.absent_zero ? "; channels that it lacks are 0" : ""),
          {{"sign", a.sign}}};
}

// Refuses what a run file cannot hold; entry k stands in line k + 1.
void check_entries(const host::RunsFile& runs) {
  for (std::size_t k = 0; k < runs.positions.size(); ++k) {
    const auto fail = [&](const std::string& what) {
      throw host::UserError(fmt::format("{}:{}: {}", runs.name, k + 1, what));
    };
    if (!host::fits_run_file(runs.positions[k])) fail("the position is out of range");
    for (const host::RunValues* const run : {&runs.up.front(), &runs.down.front()}) {
      if (!host::fits_run_file((*run)[k].cwiseAbs().maxCoeff())) fail("the error is out of range");
    }
    if (k > 0 && runs.positions[k] - runs.positions[k - 1] < host::kNearestTargets)
      fail(fmt::format("positions nearer than {} {} are one in a run file", host::kNearestTargets,
                       host::is_rotary_letter(runs.letter) ? "rad" : "mm"));
  }
}

// A trim is what is added to the command, so the error of the axis is minus the trim.
host::RunsFile runs_of_comp(const host::LinuxcncComp& table, const std::string& name, char axis,
                            double unit) {
  host::RunsFile runs;
  runs.name = name;
  runs.letter = axis;
  const bool rotary = host::is_rotary_letter(axis);
  const Eigen::Index channel = rotary ? 3 + (axis - 'A') : axis - 'X';
  const auto errors = [&](const std::vector<double>& trim) {
    host::RunValues values;
    for (const double t : trim) {
      ErrorMotion e = ErrorMotion::Zero();
      e(channel) = -t * unit;
      values.push_back(e);
    }
    return values;
  };
  for (const double at : table.nominal)
    runs.positions.push_back(at * unit);
  runs.up.push_back(errors(table.forward));
  runs.down.push_back(errors(table.reverse));
  check_entries(runs);
  return runs;
}

Imported import_linuxcnc(const ImportArguments& a) {
  const char axis = a.axis.front();
  if (host::is_rotary_letter(axis) != (a.unit == "deg"))
    throw host::UserError(fmt::format("--unit {}: of the wrong kind for axis {}", a.unit, axis));
  host::InputFile file(a.files.front());
  const host::LinuxcncComp table = host::read_linuxcnc(file.stream(), file.name(), a.type);
  if (a.absent != "zero")
    throw host::UserError(fmt::format(
        "{}: the file holds one error motion of axis {}; --absent zero writes the other five as 0",
        file.name(), axis));
  const double unit = a.unit == "mm" ? 1.0 : a.unit == "inch" ? 25.4 : kPi / 180.0;
  return {
      {runs_of_comp(table, file.name(), axis, unit)},
      "",
      fmt::format("imported from a LinuxCNC compensation file of type {}, {}; positioning of the "
                  "tool with respect to the work (convention relative), all other channels are 0",
                  a.type, a.unit),
      {{"type", a.type}, {"unit", a.unit}}};
}

CLI::App* add_format(CLI::App& import, const char* name, const char* what, ImportArguments& a,
                     int most_files) {
  CLI::App* format = import.add_subcommand(name, what);
  format->add_option("FILE", a.files, "What to read")->required()->expected(1, most_files);
  format->add_option("--out", a.out, "Folder to write runs_X.csv … to")->required();
  format->add_option("--json", a.json_file,
                     "Write what was read and written to this file (-: standard output)");
  format
      ->add_option("--absent", a.absent,
                   "zero: channels that are not in the file are written as 0; without it they are "
                   "missing")
      ->check(CLI::IsMember({"zero"}));
  return format;
}

void add_error_format(CLI::App& import, const char* name, const char* what, ReadForeign read,
                      int& code) {
  auto a = std::make_shared<ImportArguments>();
  CLI::App* format = add_format(import, name, what, *a, 64);
  format->add_option("--sign", a->sign, "What the values are; the format does not say it")
      ->required()
      ->check(CLI::IsMember({"actual-minus-nominal", "nominal-minus-actual"}));
  format->callback(
      [a, read, &code] { code = import_with(*a, [&] { return import_errors(*a, read); }); });
}

}  // namespace

void add_import_command(CLI::App& app, int& code) {
  CLI::App* import =
      app.add_subcommand("import", "Turn error tables of other programs into run files (CSV)");
  import->require_subcommand(1);
  add_error_format(*import, "isg-csv", "Volumetric compensation of ISG and TwinCAT CNC (ISG CSV)",
                   host::read_isg_csv, code);
  add_error_format(*import, "etalon", "Exchange files of Etalon, variant Vendor", host::read_etalon,
                   code);

  auto a = std::make_shared<ImportArguments>();
  CLI::App* linuxcnc =
      add_format(*import, "linuxcnc", "Screw compensation of LinuxCNC (COMP_FILE)", *a, 1);
  linuxcnc->add_option("--axis", a->axis, "Axis of the joint")
      ->required()
      ->check(CLI::IsMember({"X", "Y", "Z", "A", "B", "C"}));
  linuxcnc->add_option("--type", a->type, "COMP_FILE_TYPE: 0 = positions, 1 = trims")
      ->required()
      ->check(CLI::IsMember({0, 1}));
  linuxcnc->add_option("--unit", a->unit, "[TRAJ] LINEAR_UNITS; deg for a rotary joint")
      ->required()
      ->check(CLI::IsMember({"mm", "inch", "deg"}));
  linuxcnc->callback([a, &code] { code = import_with(*a, [&] { return import_linuxcnc(*a); }); });
}

}  // namespace volcomp::cli
