#include "host_sim/experiments/any_machine/machine_spread.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host_sim/experiments/any_machine/figures.hpp"
#include "host_sim/host/io/version.hpp"
#include "host_sim/host/machine/chain_string.hpp"
#include "host_sim/host/report/charts.hpp"
#include "host_sim/host/report/provenance.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::any_machine {
namespace {

using nlohmann::json;

constexpr double kWantedMachines = 15.0 / 16.0;

std::string measured_note(const MachineSpread& spread) {
  return fmt::format("Each with errors, places and noise of its own, measured with {}.",
                     spread.options.noise ? "realistic instruments" : "perfect instruments");
}

json settings_of(const MachineSpread& s) {
  return {{"inputs", host::hashes_of(s.inputs)},
          {"machine", s.machine},
          {"chain", s.chain},
          {"seed", s.options.seed},
          {"noise", s.options.noise},
          {"runs", s.options.runs},
          {"places", s.options.places},
          {"knots", s.options.knots},
          {"tool_length_mm", s.options.tool_length_mm}};
}

}  // namespace

std::size_t MachineSpread::good() const {
  return static_cast<std::size_t>(
      std::count_if(drawn.begin(), drawn.end(), [](const JudgedMachine& m) { return m.good; }));
}

MachineSpread run_machine_spread(const MachineOptions& options, const host::DrawPlan& plan,
                                 const host::Progress& progress) {
  MachineSpread spread;
  spread.options = options;
  const host::MachineFile file = host::read_machine_file(options.machine);
  spread.machine = file.name;
  spread.chain = host::chain_text(file.chain);
  spread.inputs = {host::hashed_file("machine file", options.machine)};
  spread.settings = settings_of(spread);
  spread.drawn = host::run_draws(
      plan, "machine", progress, [&](std::size_t draw, const host::Progress& of_draw) {
        MachineOptions one = options;
        one.seed = options.seed + draw;
        const MachineResult result = run_machine(one, of_draw);
        return JudgedMachine{judged_figures(result), machine_verdict(result).ok};
      });
  return spread;
}

host::PartialRun part_of_machine_spread(const MachineSpread& spread, const host::DrawPlan& plan) {
  return host::part_of_draws("machine", plan, spread.settings, spread.drawn, judged_json);
}

MachineSpread collect_machine_spread(const host::PartialRun& all) {
  MachineSpread spread;
  spread.settings = all.run;
  spread.options.seed = all.run.at("seed").get<std::uint64_t>();
  spread.options.noise = all.run.at("noise").get<bool>();
  spread.machine = host::text_of_part(all.run.at("machine"), "machine");
  spread.chain = host::text_of_part(all.run.at("chain"), "chain");
  spread.drawn = host::results_of_draws(all, judged_of);
  require_same_figures(spread.drawn);
  return spread;
}

host::Verdict machine_spread_verdict(const MachineSpread& spread) {
  const auto count = static_cast<double>(spread.drawn.size());
  const bool ok = static_cast<double>(spread.good()) >= kWantedMachines * count;
  return {ok, fmt::format("{} of {} machines are good (15 of 16 wanted): each figure {}.",
                          spread.good(), spread.drawn.size(),
                          spread.options.noise ? "at most half of what it was, or 5 µm"
                                               : "at most a tenth of what it was, or 1 µm")};
}

json machine_spread_document(const MachineSpread& spread, const host::RunContext& run) {
  host::ReportParts parts;
  parts.title = fmt::format("{}: {} machines before and after compensation", spread.machine,
                            spread.drawn.size());
  parts.subtitle = "Simulated machines with errors drawn at random";
  parts.verdict = machine_spread_verdict(spread);
  parts.before_after = spread_table(spread.drawn, measured_note(spread));
  parts.plots = json::array({what_is_left(spread.drawn)});
  host::Origins origins;
  origins.data = "simulated: no machine was measured";
  origins.settings = {
      {"chain", spread.chain},
      {"seeds", fmt::format("{} to {} (errors of the machine, places, noise)", spread.options.seed,
                            spread.options.seed + spread.drawn.size() - 1)}};
  origins.inputs = spread.inputs;
  origins.instruments = {spread.options.noise ? "realistic" : "perfect"};
  origins.chosen = {"errors of the machines: drawn at random"};
  parts.provenance = host::provenance(run, origins);
  return host::report_document(std::move(parts));
}

std::string machine_spread_summary(const MachineSpread& spread) {
  return host::terminal_text(machine_spread_document(spread, {}));
}

json machine_spread_figures(const MachineSpread& spread) {
  json figures = spread.settings;
  figures.update(
      {{"machines", spread.drawn.size()},
       {"good", spread.good()},
       {"figures", host::figures_of_table(spread_table(spread.drawn, measured_note(spread)))},
       {"ok", machine_spread_verdict(spread).ok},
       {"version", host::kVersion}});
  return figures;
}

}  // namespace volcomp::any_machine
