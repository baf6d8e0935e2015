// volcomp collect

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/experiments/face_gear/spread.hpp"
#include "host_sim/experiments/l300g/spread.hpp"
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

Collected of_xyfz(const host::PartialRun& all) {
  xyfz::CollectedXyfz c = xyfz::collect_xyfz(all);
  // From a file: nothing in it may speak to the terminal.
  for (char& byte : c.verdict.text)
    if (static_cast<unsigned char>(byte) < ' ') byte = '?';
  const nlohmann::json document{{"sections", nlohmann::json::array()},
                                {"verdict", {{"ok", c.verdict.ok}, {"text", c.verdict.text}}}};
  return {host::text_of(document), c.figures, c.verdict.ok};
}

Collected of_l300g(const host::PartialRun& all) {
  const l300g::SpreadResult r = l300g::collect_spread(all);
  nlohmann::json figures = l300g::spread_figures(r);
  figures.update(all.figures);
  return {l300g::spread_summary(r), std::move(figures), l300g::spread_verdict(r).ok};
}

Collected of_face_gear(const host::PartialRun& all) {
  const face_gear::SpreadResult r = face_gear::collect_spread(all);
  nlohmann::json figures = face_gear::spread_figures(r);
  figures.update(all.figures);
  return {face_gear::spread_summary(r), std::move(figures), face_gear::spread_verdict(r).ok};
}

Collected collected_of(const std::string& name, const host::PartialRun& all) {
  try {
    if (all.experiment == "xyfz") return of_xyfz(all);
    if (all.experiment == "l300g") return of_l300g(all);
    if (all.experiment == "face-gear") return of_face_gear(all);
  } catch (const nlohmann::json::exception&) {
    throw host::UserError("a result in one of the parts is missing or of another kind");
  }
  throw host::UserError(fmt::format("{}: parts of \"{}\" are not known", name, all.experiment));
}

int collect(const CollectArguments& a) {
  Results results({a.json_file}, a.parts);
  const host::PartialRun all = host::collect_parts({a.parts.begin(), a.parts.end()});
  const Collected collected = collected_of(a.parts.front(), all);
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
