// volcomp import

#include <fstream>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "comp/units.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/controller_tables/linuxcnc_comp.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/data/whole_file.hpp"
#include "host_sim/exchange/etalon_text.hpp"
#include "host_sim/exchange/foreign_errors.hpp"
#include "host_sim/exchange/isg_csv.hpp"

namespace volcomp::sim {
namespace {

struct ImportArguments {
  std::vector<std::string> files;
  std::string sign;
  std::string absent;
  std::string out;
  // LinuxCNC
  std::string axis;
  std::string unit;
  int type = -1;
};

std::string names_of(const std::vector<std::string>& files) {
  return fmt::format("{}", fmt::join(files, ", "));
}

// `origin` heads each file as a comment.
int write_runs_to(const ImportArguments& a, const std::vector<RunsFile>& runs,
                  const std::string& locations, const std::string& origin) {
  std::vector<NamedText> files;
  for (const RunsFile& run : runs) {
    std::ostringstream text;
    text << "# " << origin << "\n";
    write_runs(text, run);
    files.push_back({fmt::format("runs_{}.csv", run.letter), text.str()});
  }
  if (!locations.empty())
    files.push_back({"location_errors.csv", "# " + origin + "\n" + locations});
  write_whole_files(a.out, files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    fmt::print("{}/{}", a.out, files[i].name);
    if (i < runs.size()) {
      fmt::print(": axis {}, {} positions, {}", runs[i].letter, runs[i].positions.size(),
                 runs[i].down.empty() ? "one direction" : "both directions");
    }
    fmt::print("\n");
  }
  if (!locations.empty())
    fmt::print("location errors are not part of run files: see [squareness] of the machine file\n");
  fmt::print(
      "values are actual - nominal, mm and rad; convention, side, sensed point and reference are "
      "said by the machine file\n");
  return 0;
}

using ReadForeign = void (*)(std::istream&, const std::string&, ForeignErrors&);

int import_errors(const ImportArguments& a, ReadForeign read) {
  ForeignErrors errors;
  for (const std::string& path : a.files) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream || std::filesystem::is_directory(path))
      throw UserError(path + ": cannot be opened");
    read(stream, path, errors);
  }
  ImportRules rules;
  rules.sign = a.sign == "actual-minus-nominal" ? 1 : -1;
  rules.absent_zero = a.absent == "zero";
  const std::string names = names_of(a.files);
  return write_runs_to(a, to_runs(errors, names, rules), locations_csv(errors, rules),
                       fmt::format("imported, values of the source are {}{}", a.sign,
                                   rules.absent_zero ? "; channels that it lacks are 0" : ""));
}

LinuxcncComp read_comp_file(const std::string& path, int type) {
  constexpr std::size_t kLargest = std::size_t{1} << 20U;
  const std::string text = read_whole_file(path, kLargest);
  try {
    return read_linuxcnc(text, type);
  } catch (const UserError& e) {
    throw UserError(fmt::format("{}: {}", path, e.what()));
  }
}

// A trim is what is added to the command, so the error of the axis is minus the trim.
RunsFile runs_of_comp(const LinuxcncComp& table, char axis, double unit) {
  RunsFile runs;
  runs.letter = axis;
  const bool rotary = is_rotary_letter(axis);
  const Eigen::Index channel = rotary ? 3 + (axis - 'A') : axis - 'X';
  const auto errors = [&](const std::vector<double>& trim) {
    RunValues values;
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
  return runs;
}

int import_linuxcnc(const ImportArguments& a) {
  const char axis = a.axis.front();
  if (is_rotary_letter(axis) != (a.unit == "deg"))
    throw UserError(fmt::format("--unit {}: of the wrong kind for axis {}", a.unit, axis));
  const LinuxcncComp table = read_comp_file(a.files.front(), a.type);
  if (a.absent != "zero")
    throw UserError(fmt::format(
        "{}: the file holds one error motion of axis {}; --absent zero writes the other five as 0",
        a.files.front(), axis));
  const double unit = a.unit == "mm" ? 1.0 : a.unit == "inch" ? 25.4 : kPi / 180.0;
  return write_runs_to(
      a, {runs_of_comp(table, axis, unit)}, "",
      fmt::format("imported from a LinuxCNC compensation file of type {}, {}; positioning of the "
                  "tool with respect to the work (convention relative), all other channels are 0",
                  a.type, a.unit));
}

CLI::App* add_format(CLI::App& import, const char* name, const char* what, ImportArguments& a,
                     int most_files) {
  CLI::App* format = import.add_subcommand(name, what);
  format->add_option("FILE", a.files, "What to read")->required()->expected(1, most_files);
  format->add_option("--out", a.out, "Folder to write runs_X.csv … to")->required();
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
  format->callback([a, read, &code] { code = import_errors(*a, read); });
}

}  // namespace

void add_import_command(CLI::App& app, int& code) {
  CLI::App* import =
      app.add_subcommand("import", "Turn error tables of other programs into run files (CSV)");
  import->require_subcommand(1);
  add_error_format(*import, "isg-csv", "Volumetric compensation of ISG and TwinCAT CNC (ISG CSV)",
                   read_isg_csv, code);
  add_error_format(*import, "etalon", "Exchange files of Etalon, variant Vendor", read_etalon,
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
  linuxcnc->callback([a, &code] { code = import_linuxcnc(*a); });
}

}  // namespace volcomp::sim
