// volcomp build-tables

#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "comp/tables/image.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/number_check.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/thermal_diagnosis.hpp"
#include "host_sim/host/report/json_format.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::cli {
namespace {

struct BuildArguments {
  std::string machine;
  std::vector<std::string> runs;
  std::string out;
  std::string json_file;
  std::string slope = "lsq";
  bool no_resampling = false;
  std::string stamp = "volcomp";
  std::optional<double> temperature_C;
  std::optional<double> expires_days;
  std::size_t knots = kDefaultKnots;
};

bool is_rotary(const host::MachineFile& machine, std::size_t a) {
  return machine.chain.axis(a).kind == JointKind::rotary;
}

std::string closed_text(const nlohmann::json& axis) {
  if (!axis.contains("turn_closed")) return "";
  const nlohmann::json& gap = axis["turn_closed"];
  return fmt::format("; ends of the turn {:.2f} µm, {:.2f} µrad apart, closed", gap["um"],
                     gap["urad"]);
}

std::string axis_line(const nlohmann::json& axis) {
  std::string figures;
  for (const char* name : {"A", "R", "E", "B", "M"})
    figures += fmt::format("{} {:.2f} ", name, axis["iso230_2"][name]);
  return fmt::format("{}  {} targets -> {} knots, {} reversal; ISO 230-2: {}{}{}\n", axis["axis"],
                     axis["targets"], axis["knots"],
                     axis["reversal_known"].get<bool>() ? "known" : "unknown", figures,
                     axis["unit"] == "um" ? "µm" : "µrad", closed_text(axis));
}

std::string expansion_text(const host::MachineFile& machine, const Provenance& provenance) {
  std::string text;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisExpansion& e = machine.thermal.expansion.at(a);
    if (e.input == kNoTemperature) continue;
    text += fmt::format("{}  grows by {:.2f} µm per m and K from {:.1f} deg C on, temperature {}\n",
                        machine.axes[a].letter, 1e6 * static_cast<double>(e.per_K),
                        provenance.temperature_C, e.input);
  }
  return text;
}

std::string words_of(const host::MachineFile& machine, const Provenance& provenance,
                     const nlohmann::json& facts) {
  std::string text;
  for (const nlohmann::json& axis : facts["axes"])
    text += axis_line(axis);
  if (facts.contains("squareness_urad")) {
    const nlohmann::json& p = facts["squareness_urad"];
    text += fmt::format("squareness in the model: a_xy {:.2f} a_xz {:.2f} a_yz {:.2f} µrad\n",
                        p["a_xy"], p["a_xz"], p["a_yz"]);
  }
  if (facts.contains("circles_less_lines_urad")) {
    const nlohmann::json& p = facts["circles_less_lines_urad"];
    text += fmt::format(
        "form of the axes, by circles less along lines: a_xy {:.2f} a_xz {:.2f} a_yz {:.2f} µrad\n",
        p["a_xy"], p["a_xz"], p["a_yz"]);
  }
  text += expansion_text(machine, provenance);
  if (facts.contains("expires_utc")) text += fmt::format("expires {} UTC\n", facts["expires_utc"]);
  for (const nlohmann::json& warning : facts["warnings"])
    text += fmt::format("warning: {}\n", warning);
  return text + fmt::format("first-order run-time model within {:.1f} nm of the exact chain\n",
                            facts["model_bound_nm"]);
}

nlohmann::json in_urad(const XyfzSquareness& p) {
  return {{"a_xy", 1e6 * p.a_xy}, {"a_xz", 1e6 * p.a_xz}, {"a_yz", 1e6 * p.a_yz}};
}

// Figures after ISO 230-2 in um or urad.
nlohmann::json axis_json(const host::MachineFile& machine, const host::BuiltTables& tables,
                         std::size_t a) {
  const BuiltTable& b = *tables.built[a];
  const Iso230Figures& f = b.positioning;
  const double scale = is_rotary(machine, a) ? 1e6 : 1e3;
  nlohmann::json j{{"axis", std::string(1, machine.axes[a].letter)},
                   {"targets", b.targets},
                   {"knots", tables.tables.axis[a].knots},
                   {"reversal_known", b.reversal_known},
                   {"unit", is_rotary(machine, a) ? "urad" : "um"},
                   {"iso230_2",
                    {{"A", scale * f.A},
                     {"R", scale * f.R},
                     {"E", scale * f.E},
                     {"B", scale * f.B},
                     {"M", scale * f.M}}}};
  if (const std::optional<host::TurnGap>& gap = tables.gaps[a])
    j["turn_closed"] = {{"um", 1e3 * gap->mm}, {"urad", 1e6 * gap->rad}};
  return j;
}

nlohmann::json build_json(const host::MachineFile& machine, const host::BuiltTables& tables,
                          const std::vector<std::uint8_t>& image) {
  nlohmann::json axes = nlohmann::json::array();
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    axes.push_back(axis_json(machine, tables, a));
  nlohmann::json j{{"machine", machine.name},
                   {"machine_id", machine.id},
                   {"bytes", image.size()},
                   {"crc32", fmt::format("{:08X}", image_crc({image.data(), image.size()}))},
                   {"model_bound_nm", tables.model_bound_nm},
                   {"temperature_C", tables.tables.provenance.temperature_C},
                   {"warnings", tables.warnings},
                   {"axes", axes}};
  if (tables.tables.provenance.expires_unix_s != 0)
    j["expires_utc"] = host::date_text(tables.tables.provenance.expires_unix_s);
  if (machine.squareness) {
    j["squareness_urad"] = in_urad(tables.parameters);
  }
  if (tables.circles_less_lines) j["circles_less_lines_urad"] = in_urad(*tables.circles_less_lines);
  return j;
}

host::BuildOptions options_of(const BuildArguments& arguments) {
  host::BuildOptions options;
  options.slope = arguments.slope == "end" ? SlopeFit::end_points : SlopeFit::least_squares;
  options.allow_resampling = !arguments.no_resampling;
  options.knots = arguments.knots;
  return options;
}

int build_tables(const BuildArguments& arguments) {
  std::vector<std::string> inputs = arguments.runs;
  inputs.push_back(arguments.machine);
  Results results({arguments.out, arguments.json_file}, std::move(inputs));
  const host::MachineFile machine = host::read_machine_file(arguments.machine);
  std::vector<host::RunsFile> runs;
  for (const std::string& path : arguments.runs)
    runs.push_back(host::read_runs_file(path));
  const auto tables = host::build_tables(machine, runs, options_of(arguments));
  Provenance& provenance = tables->tables.provenance;
  provenance.built_unix_s = static_cast<std::int64_t>(std::time(nullptr));
  if (arguments.temperature_C)
    provenance.temperature_C = static_cast<float>(*arguments.temperature_C);
  const double days = arguments.expires_days.value_or(machine.thermal.expires_days);
  if (days > 0.0) {
    provenance.expires_unix_s =
        provenance.built_unix_s + static_cast<std::int64_t>(std::ceil(86'400.0 * days));
  }
  arguments.stamp.copy(provenance.stamp.data(), provenance.stamp.size());
  const std::vector<std::uint8_t> image = host::make_image(tables->tables);
  results.add(arguments.out, {reinterpret_cast<const char*>(image.data()), image.size()});
  const nlohmann::json facts = build_json(machine, *tables, image);
  results.add(arguments.json_file, json_text(facts));
  results.write();
  fmt::print(results.text(), "{}{}: {} bytes, machine {}, CRC-32 {}\n",
             words_of(machine, provenance, facts), shown_output(arguments.out), image.size(),
             machine.id, facts["crc32"]);
  return 0;
}

}  // namespace

void add_build_tables_command(CLI::App& app, int& code) {
  CLI::App* build =
      app.add_subcommand("build-tables", "Build the table image of a machine from measured runs");
  auto a = std::make_shared<BuildArguments>();
  build->add_option("--machine", a->machine, "Machine file (TOML)")->required();
  build->add_option("--runs", a->runs, "Run files (CSV), one per axis")->required();
  build->add_option("--out", a->out, "Image file to write (-: standard output)")->required();
  build->add_option("--json", a->json_file,
                    "Write the figures of every axis to this file (-: standard output)");
  build
      ->add_option("--slope", a->slope,
                   "Line removed from straightness: least squares or end points")
      ->check(CLI::IsMember({"lsq", "end"}))
      ->capture_default_str();
  build->add_flag("--no-resampling", a->no_resampling,
                  "Refuse targets that are not equally spaced");
  build
      ->add_option("--knots", a->knots,
                   "Most knots of a table: what the node has room for (M4F board: 64)")
      ->check(CLI::Range(std::size_t{2}, kDefaultKnots))
      ->capture_default_str();
  build
      ->add_option("--temperature", a->temperature_C,
                   "Temperature of the campaign, deg C (default: that of the machine file)")
      ->check(number_between(static_cast<double>(kLeastTemperature_C),
                             static_cast<double>(kMostTemperature_C)));
  build
      ->add_option("--expires", a->expires_days,
                   "Days until the tables expire, 0: never (default: that of the machine file)")
      ->check(number_between(0.0, host::kMostExpiry_days));
  build->add_option("--stamp", a->stamp, "Operator, up to 16 characters")->capture_default_str();
  build->callback([a, &code] { code = build_tables(*a); });
}

}  // namespace volcomp::cli
