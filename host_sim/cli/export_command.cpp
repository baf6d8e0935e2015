// volcomp export-tables

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/host/tables/controller_export.hpp"

namespace volcomp::cli {
namespace {

struct ExportArguments {
  std::string machine;
  std::vector<std::string> runs;
  std::string image;
  std::string out;
  std::string json_file;
  host::ExportOptions options;
};

struct Source {
  std::string name;
  host::TableModel tables;
};

Source source_of(const ExportArguments& a) {
  if (!a.image.empty()) {
    const std::string name = host::shown_name(a.image);
    return {name, host::table_model(*host::read_tables_file(a.image), name)};
  }
  if (a.machine.empty() || a.runs.empty())
    throw host::UserError("nothing to export: give --image, or --machine and --runs");
  const host::MachineFile machine = host::read_machine_file(a.machine);
  std::vector<host::RunsFile> runs;
  for (const std::string& path : a.runs)
    runs.push_back(host::read_runs_file(path));
  const auto built =
      host::build_tables(machine, runs, host::tables_only(host::ModelKind::abbe_closed));
  return {a.machine, host::table_model(built->tables, a.machine)};
}

nlohmann::json vector_json(const Vec3& v) { return {v(0), v(1), v(2)}; }

nlohmann::json export_json(const host::ControllerExport& result) {
  nlohmann::json formats = nlohmann::json::array();
  for (const host::ExportedFormat& f : result.formats) {
    nlohmann::json names = nlohmann::json::array();
    for (const host::NamedText& file : f.files)
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

void print_format(std::FILE* words, const host::ExportedFormat& f,
                  const host::ControllerExport& result) {
  fmt::print(words, "{}:\n", f.name);
  for (const host::NamedText& file : f.files)
    fmt::print(words, "  {}\n", file.name);
  fmt::print(words, "  units: {}; rounding {} µm\n  sign: {}\n  cannot hold: {}\n", f.units,
             f.half_step_um, f.sign, f.not_held);
  if (!f.both_directions) {
    fmt::print(words, "  mean of both directions; they differ by up to {:.3f} {:.3f} {:.3f} µm\n",
               result.reversal_um(0), result.reversal_um(1), result.reversal_um(2));
  }
  fmt::print(words,
             "  not represented: X up to {:.3f}, Y up to {:.3f}, Z up to {:.3f} µm; {:.3f} µm rms\n"
             "  on the controller: {}\n",
             f.remainder_max_um(0), f.remainder_max_um(1), f.remainder_max_um(2),
             f.remainder_rms_um, f.to_do);
}

std::vector<std::string> inputs_of(const ExportArguments& a) {
  std::vector<std::string> inputs = a.runs;
  inputs.insert(inputs.end(), {a.image, a.machine});
  return inputs;
}

int export_tables_to(const ExportArguments& a) {
  Results results({a.json_file}, inputs_of(a), a.out);
  const Source source = source_of(a);
  const host::ControllerExport result = host::export_tables(source.tables, source.name, a.options);
  std::vector<host::NamedText> files;
  for (const host::ExportedFormat& format : result.formats)
    files.insert(files.end(), format.files.begin(), format.files.end());
  results.add_files(a.out, files);
  results.add(a.json_file, json_text(export_json(result)));
  results.write();
  fmt::print(results.text(), "{}: {} files; entries X {} Y {} Z {}\n", a.out, files.size(),
             result.entries[0], result.entries[1], result.entries[2]);
  for (const host::ExportedFormat& format : result.formats)
    print_format(results.text(), format, result);
  return 0;
}

void add_controller_options(CLI::App& command, host::ExportOptions& o) {
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
                      "Write the figures to this file (-: standard output)");
  add_controller_options(*command, a->options);
  command->callback([a, &code] {
    std::vector<std::string>& formats = a->options.formats;
    std::sort(formats.begin(), formats.end());
    formats.erase(std::unique(formats.begin(), formats.end()), formats.end());
    code = export_tables_to(*a);
  });
}

}  // namespace volcomp::cli
