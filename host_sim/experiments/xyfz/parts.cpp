#include "host_sim/experiments/xyfz/parts.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/machines.hpp"
#include "host_sim/experiments/xyfz/report.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

json run_of(const XyfzResult& r) {
  json inputs = json::array();
  for (const host::HashedInput& input : r.inputs)
    if (input.what == "machine file") inputs.push_back(input.sha256);
  const XyfzOptions& o = r.options;
  return {{"machine_file", inputs},
          {"seed", o.seed},
          {"machine_seed", o.machine_seed},
          {"runs", o.runs},
          {"knots", o.knots},
          {"only", name_of(o.only)},
          {"volume_points", o.volume_points},
          {"squareness",
           {{"noise_free", kFunctionalNames.at(static_cast<std::size_t>(o.noise_free))},
            {"noisy", kFunctionalNames.at(static_cast<std::size_t>(o.noisy))}}},
          {"noise_free_text", noise_free_verdict(r).text},
          {"noise_free_ok", noise_free_verdict(r).ok}};
}

CollectedXyfz collected_machines(const host::PartialRun& all) {
  const MachinesResult r = collect_machines(all);
  return {machines_figures(r), machines_verdict(r)};
}

}  // namespace

host::PartialRun part_of_xyfz(const XyfzResult& r) {
  host::PartialRun part{"xyfz", r.options.draws, run_of(r), noise_free_figures(r), {}};
  const std::vector<std::size_t> own = r.options.shard.draws_of(r.options.draws);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const DrawResult& d = r.draws[i];
    part.draw[own[i]] = {{"raw_um", d.raw_um}, {"residual_um", d.residual_um}};
  }
  return part;
}

CollectedXyfz collect_xyfz(const host::PartialRun& all) {
  if (all.run.contains("machines")) return collected_machines(all);
  XyfzResult r;
  for (const auto& [number, result] : all.draw) {
    DrawResult d;
    d.raw_um = host::numbers_of<1>(json::array({result.at("raw_um")}), "raw_um")[0];
    d.residual_um = host::numbers_of<3>(result.at("residual_um"), "residual_um");
    r.draws.push_back(d);
  }
  CollectedXyfz collected{all.figures, {}};
  add_draw_figures(r, collected.figures);
  collected.verdict = {all.run.at("noise_free_ok").get<bool>(),
                       all.run.at("noise_free_text").get<std::string>()};
  add_draw_verdict(r, collected.verdict);
  return collected;
}

}  // namespace volcomp::xyfz
