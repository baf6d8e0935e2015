#include "host_sim/sim/instruments/noise_classes.hpp"

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {

NoiseClasses no_noise() {
  NoiseClasses n;
  for (double* size :
       {&n.repeatability_mm, &n.repeatability_rad, &n.scale, &n.straightness_gain, &n.angle_gain,
        &n.roll_rad, &n.straightness_wave_mm, &n.angle_wave_rad, &n.beam_rad, &n.arm_mm,
        &n.laser.growth_K, &n.laser.drift_mm, &n.ball_bar_rad, &n.temperature_K, &n.interferometer})
    *size = 0.0;
  return n;
}

NoiseClasses workshop_noise(const host::MachineFile& file) {
  NoiseClasses n;
  n.laser = file.laser;
  return n;
}

NoiseClasses only(NoiseSource source, const NoiseClasses& all) {
  NoiseClasses n = no_noise();
  n.laser = all.laser;
  n.laser.drift_mm = n.laser.growth_K = 0.0;
  n.laser.roll_by_level = false;
  const auto keep = [&](auto... member) { ((n.*member = all.*member), ...); };
  using N = NoiseClasses;
  switch (source) {
    case NoiseSource::repeatability:
      keep(&N::repeatability_mm, &N::repeatability_rad);
      break;
    case NoiseSource::laser:
      keep(&N::scale, &N::straightness_gain, &N::angle_gain, &N::straightness_wave_mm,
           &N::angle_wave_rad, &N::beam_rad);
      break;
    case NoiseSource::roll:
      keep(&N::roll_rad);
      n.laser.roll_by_level = all.laser.roll_by_level;
      break;
    case NoiseSource::levers:
      keep(&N::arm_mm);
      break;
    case NoiseSource::drift:
      n.laser.drift_mm = all.laser.drift_mm;
      break;
    case NoiseSource::temperature:
      keep(&N::temperature_K);
      n.laser.growth_K = all.laser.growth_K;
      break;
    case NoiseSource::ball_bar:
      keep(&N::ball_bar_rad);
      break;
    case NoiseSource::interferometer:
      keep(&N::interferometer);
      break;
  }
  return n;
}

const char* name_of(const std::optional<NoiseSource>& only) {
  return only ? kNoiseSources.at(static_cast<std::size_t>(*only)) : "everything";
}

Drift drift_of(const host::LaserFile& laser) {
  if (laser.drift == 0) return {DriftKind::walk, 0.0, 1.0};
  return {static_cast<DriftKind>(laser.drift - 1), laser.drift_mm, laser.drift_tau_s};
}

double check_temperature(const NoiseClasses& classes, const CampaignDraw& draw) {
  return classes.temperature_K *
         normal(draw.seed, {static_cast<std::uint32_t>(RandomStream::temperature), draw.draw,
                            kCommon, kCommon});
}

}  // namespace volcomp::sim
