#include "host_sim/experiments/internal_helical/scenario.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/metrology/gears/internal_gear_deviations.hpp"
#include "host_sim/experiments/internal_helical/bus_grinder.hpp"
#include "host_sim/experiments/internal_helical/grinding_job.hpp"
#include "host_sim/experiments/internal_helical/integrated_grinder.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::internal_helical {
namespace {

// Profiles are taken evenly around the gear; of 79 slots 0, 20, 39 and 59.
constexpr int kProfileSlots = 4;

HelicalInspection inspect_gear(const InternalGear& gear, const FlankGrinding& grinding,
                               const std::vector<StrokeTrace>& passes, double probe_mm,
                               sim::Random& random) {
  HelicalInspection result;
  for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
    HelicalPitch& pitch = result.pitch[side];
    for (const StrokeTrace& pass : passes) {
      const double dn = grinding.pitch_point(pass, side) + random.normal(probe_mm);
      pitch.position.push_back(kUmPerMm * pitch_arc_towards_plus(gear, kHelicalSides[side], dn));
    }
    host::require(evaluate_pitch(pitch.position, pitch.figures), "pitch");
  }
  for (int k = 0; k < kProfileSlots; ++k) {
    const auto slot = static_cast<std::size_t>((k * gear.teeth + 1) / kProfileSlots);
    for (std::size_t side = 0; side < kHelicalSides.size(); ++side) {
      HelicalProfile profile{slot, side, {}, {}};
      for (std::size_t i = 0; i < kProfilePoints; ++i) {
        const double dn =
            grinding.profile_point(passes.at(slot), side, i) + random.normal(probe_mm);
        profile.deviation.push_back(kUmPerMm * transverse_of(gear, dn));
      }
      host::require(
          evaluate_internal_profile(grinding.roll_length(), profile.deviation, profile.figures),
          "profile");
      result.F_alpha = std::max(result.F_alpha, profile.figures.total);
      result.profile.push_back(profile);
    }
  }
  return result;
}

std::unique_ptr<GrinderControl> make_control(const host::MachineFile& machine,
                                             const host::WatchedStrokes& watched,
                                             const InternalHelicalOptions& options,
                                             GrindingProcess& process) {
  if (!options.make_axes)
    return std::make_unique<IntegratedGrinder>(watched, options.way, process.plant(),
                                               options.watch);
  if (options.way == LearningWay::one_table)
    throw host::UserError(
        "--wrong one-table: a node keeps a table for each direction; without --can "
        "one table can be learned for both");
  return std::make_unique<BusGrinder>(grinder_axes(machine, watched, options.make_axes),
                                      process.standing(), process.plant());
}

// One grinder with its compensation, from the first gear to the last.
class Campaign {
 public:
  Campaign(const host::MachineFile& machine, const host::GrindingFile& job,
           const FlankGrinding& grinding, const InternalHelicalOptions& options, std::uint64_t seed)
      : gear_(job.gear),
        grinding_(grinding),
        truth_(options.truth),
        updates_(options.updates),
        process_(job, options.truth, seed),
        control_(make_control(machine, watched_strokes(job, grinding.flank_per_x(), options.way),
                              options, process_)),
        measuring_(seed + 1'000'000) {}

  // `share` receives how much of it is done.
  SeedResult run(HelicalDetail* detail, const std::function<void(double)>& share) {
    SeedResult result;
    for (int update = 0; update < updates_; ++update) {
      for (int i = 0; i < kRoundsPerUpdate; ++i) {
        share((update * kRoundsPerUpdate + i) / (updates_ * kRoundsPerUpdate + 2.0));
        const GroundGear gear = grind(update == 0 && i == 0, detail, &HelicalDetail::pass_before);
        if (update == 0 && i == 0) result.before = gear;
        result.learning_um.push_back(gear.sync_rms_um);
      }
      if (update == 0 && detail != nullptr) detail->before = control_->view();
      control_->learn();
    }
    result.after = grind(true, detail, &HelicalDetail::pass_after);
    result.learning_um.push_back(result.after.sync_rms_um);
    if (detail != nullptr) {
      static_cast<void>(grind(false, nullptr, nullptr));  // so that every slot is seen both ways
      detail->after = control_->view();
      detail->tables = control_->tables();
    }
    return result;
  }

 private:
  GroundGear grind(bool inspect, HelicalDetail* detail,
                   std::array<StrokeTrace, 2> HelicalDetail::*kept) {
    GroundGear gear;
    squares_ = samples_ = 0.0;
    const std::vector<StrokeTrace> passes = process_.round([this, &gear](const StrokeStep& step) {
      if (step.in_face) look_at_flank(step, gear);
      control_->cycle(step);
    });
    gear.sync_rms_um = std::sqrt(squares_ / samples_);
    if (!inspect) return gear;
    gear.inspection = inspect_gear(gear_, grinding_, passes, truth_.probe_mm, measuring_);
    if (detail != nullptr) detail->*kept = {passes[0], passes[1]};
    return gear;
  }

  // Independent of the signals that the compensation uses.
  void look_at_flank(const StrokeStep& step, GroundGear& gear) {
    GrinderPlant& plant = process_.plant();
    const double e_z = static_cast<double>(plant.read_z() - step.z) / kNmPerMm;
    const double e_c = static_cast<double>(plant.read_c() - step.c) / kWirePerRad;
    const double flank =
        kUmPerMm * synchronisation_on_flank(gear_, synchronisation_error(gear_, e_z, e_c));
    squares_ += flank * flank;
    samples_ += 1.0;
    gear.z_peak_mm = std::max(gear.z_peak_mm, std::abs(e_z));
  }

  const InternalGear& gear_;
  const FlankGrinding& grinding_;
  GrindingTruth truth_;
  int updates_;
  GrindingProcess process_;
  std::unique_ptr<GrinderControl> control_;
  sim::Random measuring_;
  double squares_ = 0.0;
  double samples_ = 0.0;
};

}  // namespace

InternalHelicalResult run_internal_helical(const InternalHelicalOptions& options,
                                           const host::Progress& progress) {
  InternalHelicalResult run;
  run.options = options;
  const host::MachineFile machine = host::read_machine_file(options.machine);
  run.inputs = {host::hashed_file("machine file", options.machine)};
  run.job = grinding_job(machine);
  run.gear = run.job.gear;
  progress(0.0, "geometry against the exact envelope");
  run.geometry = check_grinding_geometry(run.job);
  const GrindingTruth& truth = options.truth;
  const double lag_z = run.job.feed_mm_per_s / truth.gain_z;
  const double lag_c = run.job.feed_mm_per_s * run.gear.turn_per_mm / truth.gain_c;
  host::require(check_learning_target(LearningTarget::c_alone, true, true, run.gear.normal_lever(),
                                      run.gear.turn_per_mm, -lag_z, lag_c, run.lags),
                "lags");
  const FlankGrinding grinding(run.job, truth);
  run.roll_length.assign(grinding.roll_length().begin(), grinding.roll_length().end());
  run.seed = host::run_draws(
      options.draws(), "seed", progress, [&](std::size_t draw, const host::Progress& of_draw) {
        const auto share = [&of_draw](double part) { of_draw(part, ""); };
        Campaign campaign(machine, run.job, grinding, options, draw + 1);
        SeedResult result = campaign.run(draw == 0 ? &run.detail : nullptr, share);
        share(1.0);
        return result;
      });
  return run;
}

}  // namespace volcomp::internal_helical
