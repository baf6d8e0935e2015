#include "host_sim/experiments/xyfz/machines.hpp"

#include <fmt/format.h>

#include "host_sim/experiments/xyfz/noisy_campaign.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/report/shared_progress.hpp"

namespace volcomp::xyfz {
namespace {

using nlohmann::json;

// How much of the whole is done when the machines are tuned, and when they are measured without
// noise.
constexpr double kTuned = 0.1;
constexpr double kNoiseFree = 0.15;

// So many seeds in vain, for each machine wanted, are enough.
constexpr std::size_t kMostInVain = 10;

// Seeds from options.machine_seed on that can show the paper's figures, as many as are wanted.
void find_machines(const host::MachineFile& file, const host::Progress& progress,
                   MachinesResult& result) {
  const XyfzOptions& options = result.options;
  std::uint64_t seed = options.machine_seed;
  while (result.machine.size() < options.machines) {
    std::vector<std::optional<XyfzTuning>> found(options.machines - result.machine.size());
    host::SharedProgress shared(progress, found.size(), 0.0, kTuned);
    host::in_parallel(found.size(), options.threads, [&](std::size_t i) {
      shared.show(i, 0.0, fmt::format("tuning machine {}", seed + i));
      found[i] = find_tuning(file, seed + i);
      shared.show(i, 1.0, fmt::format("tuning machine {}", seed + i));
    });
    for (const std::optional<XyfzTuning>& tuning : found) {
      if (tuning)
        result.machine.push_back({seed, *tuning, {}, {}, {}});
      else
        result.passed_over.push_back(seed);
      ++seed;
    }
    if (result.passed_over.size() > kMostInVain * options.machines)
      throw host::UserError(fmt::format(
          "only {} of the machine seeds {} to {} have a machine with the paper's figures",
          result.machine.size(), options.machine_seed, seed - 1));
  }
}

std::vector<std::unique_ptr<Bench>> benches_of(const host::MachineFile& file,
                                               const MachinesResult& result) {
  std::vector<std::unique_ptr<Bench>> benches;
  for (const StudiedMachine& machine : result.machine) {
    XyfzOptions own = result.options;
    own.machine_seed = machine.seed;
    benches.push_back(std::make_unique<Bench>(own, file, machine.tuning));
  }
  return benches;
}

void measure_noise_free(const std::vector<std::unique_ptr<Bench>>& benches,
                        const host::Progress& progress, MachinesResult& result) {
  host::SharedProgress shared(progress, benches.size(), kTuned, kNoiseFree);
  host::in_parallel(benches.size(), result.options.threads, [&](std::size_t m) {
    const host::TemporaryFolder folder;
    CheckedCampaign measured = noise_free_campaign(*benches[m], folder.path());
    result.machine[m].noise_free = compensate(*benches[m], measured).pnp;
    result.machine[m].functionals = circles_less_lines(benches[m]->truth, benches[m]->machine);
    shared.show(m, 1.0, fmt::format("machine {} without noise", result.machine[m].seed));
  });
}

void measure_with_noise(const std::vector<std::unique_ptr<Bench>>& benches,
                        const host::Progress& progress, MachinesResult& result) {
  const XyfzOptions& options = result.options;
  const std::vector<std::size_t> own = options.shard.draws_of(options.machines * options.draws);
  std::vector<DrawResult> draws(own.size());
  host::SharedProgress shared(progress, own.size(), kNoiseFree);
  host::in_parallel(own.size(), options.threads, [&](std::size_t i) {
    const std::size_t machine = own[i] / options.draws;
    const host::TemporaryFolder folder;
    CheckedCampaign measured = noisy_campaign(*benches[machine], folder.path(), own[i]);
    draws[i] = compensate(*benches[machine], measured).pnp;
    shared.show(i, 1.0,
                fmt::format("campaign {} of {} on machine {}", own[i] % options.draws + 1,
                            options.draws, result.machine[machine].seed));
  });
  for (std::size_t i = 0; i < own.size(); ++i)
    result.machine[own[i] / options.draws].draws.push_back(draws[i]);
}

json settings_of(const MachinesResult& r) {
  const XyfzOptions& o = r.options;
  return {{"machine_file", r.inputs.front().sha256},
          {"seed", o.seed},
          {"machine_seed", o.machine_seed},
          {"machines", o.machines},
          {"draws", o.draws},
          {"runs", o.runs},
          {"knots", o.knots},
          {"only", name_of(o.only)},
          {"squareness",
           {{"noise_free", kFunctionalNames.at(static_cast<std::size_t>(o.noise_free))},
            {"noisy", kFunctionalNames.at(static_cast<std::size_t>(o.noisy))}}}};
}

json draw_json(const DrawResult& d) {
  return {{"raw_um", d.raw_um}, {"residual_um", d.residual_um}};
}

DrawResult draw_of(const json& draw) {
  DrawResult d;
  d.raw_um = host::numbers_of<1>(json::array({draw.at("raw_um")}), "raw_um")[0];
  d.residual_um = host::numbers_of<3>(draw.at("residual_um"), "residual_um");
  return d;
}

}  // namespace

std::vector<DrawResult> MachinesResult::all_noise_free() const {
  std::vector<DrawResult> all;
  all.reserve(machine.size());
  for (const StudiedMachine& m : machine)
    all.push_back(m.noise_free);
  return all;
}

std::vector<DrawResult> MachinesResult::all_draws() const {
  std::vector<DrawResult> all;
  for (const StudiedMachine& m : machine)
    all.insert(all.end(), m.draws.begin(), m.draws.end());
  return all;
}

std::vector<CirclesLessLines> MachinesResult::all_functionals() const {
  std::vector<CirclesLessLines> all;
  all.reserve(machine.size());
  for (const StudiedMachine& m : machine)
    all.push_back(m.functionals);
  return all;
}

std::size_t MachinesResult::reaching(std::size_t model) const {
  std::size_t reaching = 0;
  for (const StudiedMachine& m : machine) {
    const double rate =
        m.draws.empty() ? m.noise_free.rate(model) : rate_quantile(m.draws, model, 0.5);
    if (rate >= kPaperRate) ++reaching;
  }
  return reaching;
}

MachinesResult run_machines(const XyfzOptions& options, const host::Progress& progress) {
  MachinesResult result;
  result.options = options;
  const host::MachineFile file = host::read_machine_file(options.machine);
  result.inputs = {host::hashed_file("machine file", options.machine)};
  result.settings = settings_of(result);
  find_machines(file, progress, result);
  const std::vector<std::unique_ptr<Bench>> benches = benches_of(file, result);
  result.noise = benches.front()->noise();
  measure_noise_free(benches, progress, result);
  measure_with_noise(benches, progress, result);
  progress(1.0, "done");
  return result;
}

host::PartialRun part_of_machines(const MachinesResult& r) {
  const XyfzOptions& o = r.options;
  host::PartialRun part{"xyfz", o.machines * o.draws, r.settings, {}, {}};
  part.figures["passed_over"] = r.passed_over;
  for (const StudiedMachine& m : r.machine)
    part.figures["machines"].push_back({{"machine_seed", m.seed},
                                        {"angle_scale", m.tuning.angle_scale},
                                        {"scale_error", m.tuning.scale_error},
                                        {"noise_free", draw_json(m.noise_free)},
                                        {"functionals", functionals_json(m.functionals)}});
  std::vector<std::size_t> taken(r.machine.size());
  for (const std::size_t draw : o.shard.draws_of(part.draws)) {
    const std::size_t m = draw / o.draws;
    part.draw[draw] = draw_json(r.machine[m].draws[taken[m]++]);
  }
  return part;
}

MachinesResult collect_machines(const host::PartialRun& all) {
  MachinesResult r;
  r.settings = all.run;
  r.options.machines = all.run.at("machines").get<std::size_t>();
  r.options.draws = all.run.at("draws").get<std::size_t>();
  r.options.seed = all.run.at("seed").get<std::uint64_t>();
  const json& machines = all.figures.at("machines");
  if (machines.empty() || machines.size() != r.options.machines ||
      all.draws != r.options.machines * r.options.draws)
    throw host::UserError("the parts are of another number of machines than they say");
  r.passed_over = all.figures.at("passed_over").get<std::vector<std::uint64_t>>();
  for (const json& m : machines)
    r.machine.push_back({m.at("machine_seed").get<std::uint64_t>(),
                         {m.at("angle_scale").get<double>(), m.at("scale_error").get<double>()},
                         draw_of(m.at("noise_free")),
                         functionals_of(m.at("functionals")),
                         {}});
  for (const auto& [number, draw] : all.draw)
    r.machine.at(number / r.options.draws).draws.push_back(draw_of(draw));
  return r;
}

}  // namespace volcomp::xyfz
