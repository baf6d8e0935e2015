// volcomp verify

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/cli/run_options.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/verification.hpp"

namespace volcomp::cli {
namespace {

struct VerifyArguments {
  std::string before;
  std::string after;
  std::vector<std::string> volume;  // before, after
  std::string uncertainty_file;
  host::UncertaintyStatement stated;
  std::optional<double> limit_um;
  std::size_t draws = 4000;
  std::uint64_t seed = 1;
  std::string machine;
  std::string tables;
  std::vector<double> box_mm;
  std::string json_file;
  std::string csv_file;
  std::string report_folder;
  std::string command;
};

DiagonalBox box_of(const VerifyArguments& a, const host::MachineFile& machine) {
  if (a.box_mm.empty()) return host::XyzAxes(machine).travel();
  DiagonalBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    box.lo(i) = a.box_mm.at(2 * k);
    box.hi(i) = a.box_mm.at(2 * k + 1);
    if (!(box.lo(i) < box.hi(i)))
      throw host::UserError(fmt::format("--box-mm: {:g} is not below {:g}", box.lo(i), box.hi(i)));
  }
  return box;
}

host::VerificationInput read_input(const VerifyArguments& a) {
  host::VerificationInput input{host::read_diagonals_file(a.before),
                                host::read_diagonals_file(a.after),
                                {},
                                {},
                                {},
                                a.limit_um,
                                {},
                                a.draws,
                                a.seed};
  if (!a.volume.empty()) {
    input.volume_before = host::read_volume_file(a.volume.at(0));
    input.volume_after = host::read_volume_file(a.volume.at(1));
  }
  if (!a.uncertainty_file.empty())
    input.uncertainty = host::read_uncertainty_file(a.uncertainty_file);
  input.uncertainty = input.uncertainty.overridden_by(a.stated);
  if (!a.tables.empty()) {
    const host::MachineFile machine = host::read_machine_file(a.machine);
    input.tables.emplace(machine, a.tables, box_of(a, machine));
  }
  return input;
}

host::Origins origins_of(const VerifyArguments& a) {
  host::Origins origins;
  host::add_origin(origins, "before", a.before);
  host::add_origin(origins, "after", a.after);
  if (!a.volume.empty()) {
    host::add_origin(origins, "volume before", a.volume.at(0));
    host::add_origin(origins, "volume after", a.volume.at(1));
  }
  if (!a.uncertainty_file.empty()) host::add_origin(origins, "uncertainty", a.uncertainty_file);
  if (!a.machine.empty()) host::add_origin(origins, "machine file", a.machine);
  if (!a.tables.empty()) host::add_origin(origins, "table image", a.tables);
  return origins;
}

std::vector<std::string> inputs_of(const VerifyArguments& a) {
  std::vector<std::string> inputs = a.volume;
  inputs.insert(inputs.end(), {a.before, a.after, a.uncertainty_file, a.machine, a.tables});
  return inputs;
}

int verify_files(const VerifyArguments& a) {
  Results results(with_report({a.json_file, a.csv_file}, a.report_folder), inputs_of(a),
                  a.report_folder);
  const host::VerificationInput input = read_input(a);
  const host::VerificationResult result = host::verify(input);
  if (!a.report_folder.empty())
    add_report(results, a.report_folder,
               host::verification_document(input, result, {a.command, {}}, origins_of(a)));
  results.add(a.json_file, json_text(host::verification_json(input, result)));
  results.add(a.csv_file, host::verification_csv(result));
  results.write();
  fmt::print(results.text(), "{}", host::verification_text(input, result));
  if (!a.report_folder.empty())
    fmt::print(results.text(), "report: {}/report.html\n", a.report_folder);
  return result.ok ? 0 : 1;
}

void add_uncertainty_options(CLI::App& verify, host::UncertaintyStatement& s) {
  const CLI::Validator not_negative = number_between(0.0, 1e6);
  const auto add = [&](const char* name, std::optional<double>& value, const char* what) {
    verify.add_option(name, value, fmt::format("{} (default: left out)", what))
        ->check(not_negative)
        ->group("Uncertainty");
  };
  add("--device-um-per-m", s.device_um_per_m,
      "Expanded uncertainty (k = 2) of the instrument, µm/m, from its certificate");
  add("--misalignment-mm", s.misalignment_mm, "Largest sideways distance of beam and diagonal, mm");
  add("--expansion-um-per-m-K", s.expansion_um_per_m_K,
      "Thermal expansion of machine or work, µm/(m K); with --temperature-K");
  add("--temperature-K", s.temperature_K, "Limits (±) of its measured temperature, K");
  add("--expansion-limits-um-per-m-K", s.expansion_limits_um_per_m_K,
      "Limits (±) of the expansion coefficient, µm/(m K); with --from-20-K");
  add("--from-20-K", s.from_20_K, "Distance of the temperature from 20 deg C, K");
  add("--eve-um", s.eve_um, "Range of a drift test as long as the measurement, µm");
  add("--volume-um", s.volume_um, "Expanded uncertainty (k = 2) of an error vector, µm");
}

}  // namespace

void add_verify_command(CLI::App& app, int argc, char** argv, int& code) {
  CLI::App* verify = app.add_subcommand(
      "verify", "Diagonals measured before and after compensation: figures, intervals, verdict");
  auto a = std::make_shared<VerifyArguments>();
  a->command = command_line(argc, argv);
  verify->add_option("BEFORE", a->before, "Diagonals without compensation (CSV)")->required();
  verify->add_option("AFTER", a->after, "The same with it (CSV)")->required();
  verify
      ->add_option("--volume", a->volume,
                   "Error vectors at places of the volume, before and after (CSV)")
      ->expected(2);
  verify
      ->add_option("--limit-um", a->limit_um,
                   "Largest deviation allowed, µm: upper bound of E of each diagonal, and in the "
                   "volume (default: none, after must be significantly better than before)")
      ->check(number_between(0.0, 1e6));
  CLI::Option* machine =
      verify->add_option("--machine", a->machine, "Machine file (TOML), for --tables");
  CLI::Option* tables = verify->add_option(
      "--tables", a->tables,
      "Image of the tables: what they predict is held against what was measured");
  tables->needs(machine);
  machine->needs(tables);
  verify
      ->add_option("--box-mm", a->box_mm,
                   "Corners of the measured volume, mm: lowest and highest X, Y and Z (default: "
                   "travel of the machine file)")
      ->expected(6)
      ->needs(tables)
      ->check(number_between(-1e6, 1e6));
  verify->add_option("--uncertainty", a->uncertainty_file,
                     "File with a table [uncertainty] (TOML); options override it");
  add_uncertainty_options(*verify, a->stated);
  verify->add_option("--draws", a->draws, "Draws behind each interval")
      ->check(CLI::Range(100, 20000))
      ->capture_default_str();
  add_seed(*verify, "--seed", a->seed, "Seed of the draws");
  verify->add_option("--json", a->json_file, "Write everything to this file (-: standard output)");
  verify->add_option("--csv", a->csv_file, "Write the figures to this file (-: standard output)");
  verify->add_option("--report", a->report_folder, "Write report.html and report.json here");
  verify->callback([a, &code] { code = verify_files(*a); });
}

}  // namespace volcomp::cli
