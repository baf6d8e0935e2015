#include "host_sim/experiments/internal_helical/parts.hpp"

#include <algorithm>

#include "host_sim/experiments/internal_helical/figures.hpp"
#include "host_sim/experiments/internal_helical/signals.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

using nlohmann::json;

constexpr std::size_t kRounds = kLearningUpdates * kRoundsPerUpdate + 1;

// So that parts can be put together without the machine file.
json job_json(const host::GrindingFile& job) {
  return {{"teeth", job.gear.teeth},
          {"module_mm", job.gear.module},
          {"pressure_angle_rad", job.gear.pressure_angle},
          {"helix_angle_rad", job.gear.helix_angle},
          {"profile_shift", job.gear.profile_shift},
          {"addendum", job.gear.addendum},
          {"dedendum", job.gear.dedendum},
          {"width_mm", job.width_mm},
          {"wheel_radius_mm", job.wheel_radius_mm},
          {"feed_mm_per_s", job.feed_mm_per_s}};
}

host::GrindingFile job_of(const json& j) {
  host::GrindingFile job;
  job.gear.teeth = j.at("teeth").get<int>();
  job.gear.module = j.at("module_mm").get<double>();
  job.gear.pressure_angle = j.at("pressure_angle_rad").get<double>();
  job.gear.helix_angle = j.at("helix_angle_rad").get<double>();
  job.gear.profile_shift = j.at("profile_shift").get<double>();
  job.gear.addendum = j.at("addendum").get<double>();
  job.gear.dedendum = j.at("dedendum").get<double>();
  host::require(derive(job.gear), "gear of the parts");
  job.width_mm = j.at("width_mm").get<double>();
  job.wheel_radius_mm = j.at("wheel_radius_mm").get<double>();
  job.feed_mm_per_s = j.at("feed_mm_per_s").get<double>();
  return job;
}

json settings_of(const InternalHelicalResult& run) {
  return {{"inputs", host::hashes_of(run.inputs)},
          {"grinding", job_json(run.job)},
          {"way", kLearningWays.at(static_cast<std::size_t>(run.options.way))},
          {"noise", run.options.scatters()}};
}

json gear_json(const GroundGear& gear) {
  const std::array<HelicalPitch, 2>& pitch = gear.inspection.pitch;
  return {{"total_pitch_um", {pitch[0].figures.total, pitch[1].figures.total}},
          {"single_pitch_um", {pitch[0].figures.single, pitch[1].figures.single}},
          {"profile_um", gear.inspection.F_alpha},
          {"sync_rms_um", gear.sync_rms_um},
          {"z_peak_mm", gear.z_peak_mm}};
}

GroundGear gear_of_part(const json& j) {
  const auto number = [&j](const char* what) {
    return host::numbers_of<1>(json::array({j.at(what)}), what)[0];
  };
  const auto total = host::numbers_of<2>(j.at("total_pitch_um"), "total_pitch_um");
  const auto single = host::numbers_of<2>(j.at("single_pitch_um"), "single_pitch_um");
  GroundGear gear;
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
    gear.inspection.pitch.at(side).figures.total = total.at(side);
    gear.inspection.pitch.at(side).figures.single = single.at(side);
  }
  gear.inspection.F_alpha = number("profile_um");
  gear.sync_rms_um = number("sync_rms_um");
  gear.z_peak_mm = number("z_peak_mm");
  return gear;
}

json seed_json(const SeedResult& seed) {
  return {{"before", gear_json(seed.before)},
          {"after", gear_json(seed.after)},
          {"learning_um", seed.learning_um}};
}

SeedResult seed_of(const json& j) {
  const auto learning = host::numbers_of<kRounds>(j.at("learning_um"), "learning_um");
  return {gear_of_part(j.at("before")),
          gear_of_part(j.at("after")),
          {learning.begin(), learning.end()}};
}

LearningWay way_named(const std::string& name) {
  const auto* const at = std::find(kLearningWays.begin(), kLearningWays.end(), name);
  if (at == kLearningWays.end()) throw host::UserError("the parts learned in an unknown way");
  return static_cast<LearningWay>(at - kLearningWays.begin());
}

// What a verdict needs of the figures that do not depend on the seeds.
GeometryCheck geometry_of(const json& figures) {
  const json& first_order = figures.at("first_order_vs_exact_nm");
  return {figures.at("regenerated_flank_nm").get<double>(), first_order.at("single").get<double>(),
          first_order.at("all").get<double>()};
}

HelixEffect lags_of(const json& j) {
  return {j.at("z").get<double>(), j.at("c").get<double>(), j.at("together").get<double>()};
}

}  // namespace

host::PartialRun part_of_helical(const InternalHelicalResult& run) {
  host::PartialRun part = host::part_of_draws("internal-helical", run.options.draws(),
                                              settings_of(run), run.seed, seed_json);
  part.figures = geometry_figures(run);
  // The monitor is shown at the first grinder.
  if (part.draw.count(0) != 0) part.draw[0]["signals"] = signal_figures(run);
  return part;
}

CollectedHelical collect_helical(const host::PartialRun& all) {
  InternalHelicalResult run;
  run.options.seeds = static_cast<int>(all.draws);
  run.options.way = way_named(all.run.at("way").get<std::string>());
  if (!all.run.at("noise").get<bool>()) run.options.truth.take_noise_away();
  run.job = job_of(all.run.at("grinding"));
  run.gear = run.job.gear;
  run.geometry = geometry_of(all.figures);
  run.lags = lags_of(all.figures.at("lags_um"));
  run.seed = host::results_of_draws(all, seed_of);
  json figures = internal_helical_figures(run, {});
  figures["signals"] = all.draw.at(0).at("signals");
  return {std::move(figures), internal_helical_verdict(run)};
}

}  // namespace volcomp::internal_helical
