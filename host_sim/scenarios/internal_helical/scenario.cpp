#include "host_sim/scenarios/internal_helical/scenario.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

// One grinder with its compensation, from the first gear to the last.
class Campaign {
 public:
  Campaign(const InternalGear& gear, const FlankGrinding& grinding,
           const InternalHelicalOptions& options, std::uint64_t seed)
      : gear_(gear),
        grinding_(grinding),
        truth_(options.truth),
        process_(gear, options.truth, seed),
        compensation_(gear, grinding.flank_per_x(), options.way),
        measuring_(seed + 1'000'000) {}

  SeedResult run(HelicalDetail* detail) {
    SeedResult result;
    for (int update = 0; update < kLearningUpdates; ++update) {
      for (int i = 0; i < kRoundsPerUpdate; ++i) {
        const GroundGear gear = grind(update == 0 && i == 0, detail, &HelicalDetail::pass_before);
        if (update == 0 && i == 0) result.before = gear;
        result.learning_um.push_back(gear.sync_rms_um);
      }
      if (update == 0 && detail != nullptr) detail->before = compensation_.view();
      compensation_.learn();
    }
    result.after = grind(true, detail, &HelicalDetail::pass_after);
    result.learning_um.push_back(result.after.sync_rms_um);
    if (detail != nullptr) {
      static_cast<void>(grind(false, nullptr, nullptr));  // so that every slot is seen both ways
      detail->after = compensation_.view();
      detail->tables = compensation_.tables();
    }
    return result;
  }

 private:
  GroundGear grind(bool inspect, HelicalDetail* detail,
                   std::array<StrokeTrace, 2> HelicalDetail::*kept) {
    GroundGear gear;
    squares_ = samples_ = 0.0;
    const std::vector<StrokeTrace> passes =
        process_.round([this, &gear](const ProcessState& state) { return sync(state, gear); });
    compensation_.collect();
    gear.sync_rms_um = std::sqrt(squares_ / samples_);
    if (!inspect) return gear;
    gear.inspection = inspect_gear(gear_, grinding_, passes, truth_.probe_mm, measuring_);
    if (detail != nullptr) detail->*kept = {passes[0], passes[1]};
    return gear;
  }

  // One SYNC: the compensation, its background at the end of every stroke, and a look at the flank
  // that is independent of what the compensation looks at.
  std::int32_t sync(const ProcessState& state, GroundGear& gear) {
    if (state.stroke_end) compensation_.collect();
    if (state.in_face) {
      const double e_z = static_cast<double>(state.z.actual - state.z.command) / kNmPerMm;
      const double e_c = static_cast<double>(state.c.actual - state.c.command) / kUnitsPerRad;
      const double flank =
          kUmPerMm * synchronisation_on_flank(gear_, synchronisation_error(gear_, e_z, e_c));
      squares_ += flank * flank;
      samples_ += 1.0;
      gear.z_peak_mm = std::max(gear.z_peak_mm, std::abs(e_z));
    }
    return compensation_.tick(state);
  }

  const InternalGear& gear_;
  const FlankGrinding& grinding_;
  GrindingTruth truth_;
  GrindingProcess process_;
  HelixCompensation compensation_;
  Random measuring_;
  double squares_ = 0.0;
  double samples_ = 0.0;
};

}  // namespace

InternalHelicalResult run_internal_helical(const InternalHelicalOptions& options,
                                           const Progress& progress) {
  InternalHelicalResult run;
  run.options = options;
  run.gear = helical_gear();
  progress(0.0, "geometry against the exact envelope");
  run.geometry = check_grinding_geometry();
  const GrindingTruth& truth = options.truth;
  const double lag_z = kStrokeFeed_mm_per_s / truth.gain_z;
  const double lag_c = kStrokeFeed_mm_per_s * run.gear.turn_per_mm / truth.gain_c;
  require(check_learning_target(LearningTarget::c_alone, true, true, run.gear.normal_lever(),
                                run.gear.turn_per_mm, -lag_z, lag_c, run.lags),
          "lags");
  const FlankGrinding grinding(run.gear, truth);
  run.roll_length.assign(grinding.roll_length().begin(), grinding.roll_length().end());
  for (int seed = 0; seed < options.seeds; ++seed) {
    progress(static_cast<double>(seed) / options.seeds, fmt::format("seed {}", seed + 1));
    Campaign campaign(run.gear, grinding, options, static_cast<std::uint64_t>(seed) + 1);
    run.seed.push_back(campaign.run(seed == 0 ? &run.detail : nullptr));
  }
  progress(1.0, "done");
  return run;
}

}  // namespace volcomp::sim
