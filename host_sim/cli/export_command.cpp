// volcomp export-tables

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/commissioning/commission.hpp"
#include "host_sim/data/user_error.hpp"
#include "host_sim/data/whole_file.hpp"
#include "host_sim/exchange/controller_export.hpp"

namespace volcomp::sim {
namespace {

struct ExportArguments {
  std::string machine;
  std::vector<std::string> runs;
  std::string image;
  std::string out;
  std::string json_file;  // empty: none; "-": the standard output
  ExportOptions options;
};

struct Source {
  std::string name;
  TableModel tables;
};

Source source_of(const ExportArguments& a) {
  if (!a.image.empty()) return {a.image, table_model(*read_tables_file(a.image), a.image)};
  if (a.machine.empty() || a.runs.empty())
    throw UserError("nothing to export: give --image, or --machine and --runs");
  const MachineFile machine = read_machine_file(a.machine);
  std::vector<RunsFile> runs;
  for (const std::string& path : a.runs)
    runs.push_back(read_runs_file(path));
  const auto built = commission(machine, runs, tables_only(ModelKind::abbe_closed));
  return {a.machine, table_model(built->tables, a.machine)};
}

nlohmann::json vector_json(const Vec3& v) { return {v(0), v(1), v(2)}; }

nlohmann::json export_json(const ControllerExport& result) {
  nlohmann::json formats = nlohmann::json::array();
  for (const ExportedFormat& f : result.formats) {
    nlohmann::json names = nlohmann::json::array();
    for (const NamedText& file : f.files)
      names.push_back(file.name);
    formats.push_back({{"format", f.name},
                       {"files", names},
                       {"units", f.units},
                       {"sign", f.sign},
                       {"not_held", f.not_held},
                       {"both_directions", f.both_directions},
                       {"rounding_um", f.half_step_um},
                       {"not_represented_max_um", vector_json(f.remainder_max_um)},
                       {"not_represented_rms_um", f.remainder_rms_um}});
  }
  return {{"entries", result.entries},
          {"reversal_um", vector_json(result.reversal_um)},
          {"formats", formats}};
}

void print_format(const ExportedFormat& f, const ControllerExport& result) {
  fmt::print("{}:\n", f.name);
  for (const NamedText& file : f.files)
    fmt::print("  {}\n", file.name);
  fmt::print("  units: {}; rounding {} um\n  sign: {}\n  cannot hold: {}\n", f.units,
             f.half_step_um, f.sign, f.not_held);
  if (!f.both_directions) {
    fmt::print("  mean of both directions; they differ by up to {:.3f} {:.3f} {:.3f} um\n",
               result.reversal_um(0), result.reversal_um(1), result.reversal_um(2));
  }
  fmt::print(
      "  not represented: X up to {:.3f}, Y up to {:.3f}, Z up to {:.3f} um; {:.3f} um rms\n"
      "  on the controller: {}\n",
      f.remainder_max_um(0), f.remainder_max_um(1), f.remainder_max_um(2), f.remainder_rms_um,
      f.to_do);
}

int export_tables_to(const ExportArguments& a) {
  const Source source = source_of(a);
  const ControllerExport result = export_tables(source.tables, source.name, a.options);
  std::vector<NamedText> files;
  for (const ExportedFormat& format : result.formats)
    files.insert(files.end(), format.files.begin(), format.files.end());
  write_whole_files(a.out, files);
  const std::string figures = export_json(result).dump(2) + "\n";
  if (a.json_file == "-") {
    fmt::print("{}", figures);
    return 0;
  }
  fmt::print("{}: {} files; entries X {} Y {} Z {}\n", a.out, files.size(), result.entries[0],
             result.entries[1], result.entries[2]);
  for (const ExportedFormat& format : result.formats)
    print_format(format, result);
  if (!a.json_file.empty()) write_whole_file(a.json_file, figures);
  return 0;
}

void add_controller_options(CLI::App& command, ExportOptions& o) {
  command
      .add_option("--entries", o.entries,
                  "Most entries of a table: what the controller has room for")
      ->check(CLI::Range(std::size_t{2}, std::size_t{129}))
      ->capture_default_str();
  command.add_option("--axis-names", o.axis_names, "Siemens: names of the machine axes X Y Z")
      ->expected(3)
      ->check(CLI::Validator(
          [](const std::string& name) {
            const bool word = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
              return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                     c == '_';
            });
            return word ? std::string() : "letters, digits and _ only: " + name;
          },
          "NAME"))
      ->capture_default_str();
  command.add_option("--first-table", o.first_table, "Siemens: number of the first $AN_CEC table")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command
      .add_option("--cec-sign", o.cec_sign,
                  "Siemens: -1 where the dial gauge shows that $AN_CEC acts the other way")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str();
  command
      .add_option("--comp-type", o.comp_type, "LinuxCNC: COMP_FILE_TYPE, 0 = positions, 1 = trims")
      ->check(CLI::IsMember({0, 1}))
      ->capture_default_str();
  command.add_option("--axis-numbers", o.axis_numbers, "ISG: logical numbers of the axes X Y Z")
      ->expected(3)
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
}

}  // namespace

void add_export_tables_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "export-tables",
      "Write the tables of a machine as compensation files of Siemens, LinuxCNC or ISG/TwinCAT");
  auto a = std::make_shared<ExportArguments>();
  CLI::Option* image = command->add_option("--image", a->image, "Table image (.vct)");
  command->add_option("--machine", a->machine, "Machine file (TOML), with --runs")->excludes(image);
  command->add_option("--runs", a->runs, "Run files (CSV), one per axis")->excludes(image);
  command->add_option("--out", a->out, "Folder to write to")->required();
  command->add_option("--format", a->options.formats, "One or several of siemens linuxcnc isg")
      ->required()
      ->check(CLI::IsMember({"siemens", "linuxcnc", "isg"}));
  command->add_option("--json", a->json_file,
                      "Write the figures to this file; - to the standard output instead of text");
  add_controller_options(*command, a->options);
  command->callback([a, &code] {
    std::vector<std::string>& formats = a->options.formats;
    std::sort(formats.begin(), formats.end());
    formats.erase(std::unique(formats.begin(), formats.end()), formats.end());
    code = export_tables_to(*a);
  });
}

}  // namespace volcomp::sim
