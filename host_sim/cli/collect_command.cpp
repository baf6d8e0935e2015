// volcomp collect

#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/experiments/any_machine/machine_spread.hpp"
#include "host_sim/experiments/face_gear/spread.hpp"
#include "host_sim/experiments/internal_helical/parts.hpp"
#include "host_sim/experiments/l300g/spread.hpp"
#include "host_sim/experiments/self_calibration/spread.hpp"
#include "host_sim/experiments/xyfz/parts.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/report/parts_of_run.hpp"
#include "host_sim/host/report/text_of.hpp"

namespace volcomp::cli {
namespace {

struct CollectArguments {
  std::vector<std::string> parts;
  std::string json_file;
};

struct Collected {
  std::string summary;
  nlohmann::json figures;
  bool good = false;
};

// The verdict alone is shown.
Collected judged(nlohmann::json figures, host::Verdict verdict) {
  // From a file: nothing in it may speak to the terminal.
  for (char& byte : verdict.text)
    if (static_cast<unsigned char>(byte) < ' ') byte = '?';
  const nlohmann::json document{{"sections", nlohmann::json::array()},
                                {"verdict", {{"ok", verdict.ok}, {"text", verdict.text}}}};
  return {host::text_of(document), std::move(figures), verdict.ok};
}

Collected of_xyfz(const host::PartialRun& all) {
  const xyfz::CollectedXyfz c = xyfz::collect_xyfz(all);
  return judged(c.figures, c.verdict);
}

Collected of_l300g(const host::PartialRun& all) {
  const l300g::SpreadResult r = l300g::collect_spread(all);
  return {l300g::spread_summary(r), l300g::spread_figures(r), l300g::spread_verdict(r).ok};
}

Collected of_face_gear(const host::PartialRun& all) {
  const face_gear::SpreadResult r = face_gear::collect_spread(all);
  return {face_gear::spread_summary(r), face_gear::spread_figures(r),
          face_gear::spread_verdict(r).ok};
}

Collected of_machine(const host::PartialRun& all) {
  const any_machine::MachineSpread r = any_machine::collect_machine_spread(all);
  return {any_machine::machine_spread_summary(r), any_machine::machine_spread_figures(r),
          any_machine::machine_spread_verdict(r).ok};
}

Collected of_self_calibration(const host::PartialRun& all) {
  const self_calibration::Spread r = self_calibration::collect_spread(all);
  return {self_calibration::spread_summary(r), self_calibration::spread_figures(r),
          self_calibration::spread_verdict(r).ok};
}

Collected of_internal_helical(const host::PartialRun& all) {
  const internal_helical::CollectedHelical c = internal_helical::collect_helical(all);
  return judged(c.figures, c.verdict);
}

constexpr std::array<std::pair<const char*, Collected (*)(const host::PartialRun&)>, 6>
    kExperiments{{{"xyfz", of_xyfz},
                  {"l300g", of_l300g},
                  {"face-gear", of_face_gear},
                  {"machine", of_machine},
                  {"self-calibration", of_self_calibration},
                  {"internal-helical", of_internal_helical}}};

Collected collected_of(const std::string& name, const host::PartialRun& all) {
  try {
    for (const auto& [experiment, collected] : kExperiments)
      if (all.experiment == experiment) return collected(all);
  } catch (const nlohmann::json::exception&) {
    throw host::UserError("a result in one of the parts is missing or of another kind");
  }
  throw host::UserError(fmt::format("{}: parts of \"{}\" are not known", name, all.experiment));
}

int collect(const CollectArguments& a) {
  Results results({a.json_file}, a.parts);
  const host::PartialRun all = host::collect_parts({a.parts.begin(), a.parts.end()});
  Collected collected = collected_of(a.parts.front(), all);
  // Where the node was, as run_experiment() adds it to the figures of a whole run.
  if (all.figures.contains("transport")) collected.figures["transport"] = all.figures["transport"];
  results.add(a.json_file, json_text(collected.figures));
  results.write();
  fmt::print(results.text(), "{}", collected.summary);
  return collected.good ? 0 : 1;
}

}  // namespace

void add_collect_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "collect", "Put the parts of a run together that --shard has written: the file of the whole");
  auto a = std::make_shared<CollectArguments>();
  command->add_option("PART", a->parts, "All parts, in any order")->required();
  command->add_option("--json", a->json_file,
                      "Write the figures of the whole run to this file (-: standard output)");
  command->callback([a, &code] { code = collect(*a); });
}

}  // namespace volcomp::cli
