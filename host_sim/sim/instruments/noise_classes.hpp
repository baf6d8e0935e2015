#pragma once
// How far the instruments of a campaign err, and how far the machine changes while it is measured.

#include <array>
#include <cstdint>
#include <optional>

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/sim/instruments/drift.hpp"

namespace volcomp::sim {

// Standard deviations but for the beam; sizes from memory, as documentation of makers has them.
struct NoiseClasses {
  // Each reading, instrument and machine together.
  double repeatability_mm = 0.7e-3;
  double repeatability_rad = 0.7e-6;
  // The laser, common to all axes of a campaign.
  double scale = 0.25e-6;  // of its wavelength
  double straightness_gain = 0.5e-2;
  double angle_gain = 0.2e-2;
  double roll_rad = 2.0e-6;  // over the travel
  // Anew at each axis.
  double straightness_wave_mm = 0.3e-3;
  double angle_wave_rad = 0.3e-6;
  double beam_rad = 0.5e-3;  // between beam and travel: ±, rectangular
  double arm_mm = 2.0;       // every component of a lever
  host::LaserFile laser;     // what a machine file says of it

  double ball_bar_rad = 3.0e-6;
  double temperature_K = 0.1;       // between campaign and check
  double interferometer = 0.25e-6;  // scale of that of the check
};

// One thing that errs; all others are perfect.
enum class NoiseSource : std::uint8_t {
  repeatability,
  laser,
  roll,
  levers,
  drift,
  temperature,
  ball_bar,
  interferometer,
};
inline constexpr std::array<const char*, 8> kNoiseSources{
    "repeatability", "laser",       "roll",     "levers",
    "drift",         "temperature", "ball-bar", "interferometer"};

[[nodiscard]] NoiseClasses no_noise();
[[nodiscard]] NoiseClasses workshop_noise(const host::MachineFile& file);
[[nodiscard]] NoiseClasses only(NoiseSource source, const NoiseClasses& all);

// "everything" without one.
[[nodiscard]] const char* name_of(const std::optional<NoiseSource>& only);

// Of each of the three lengths that a laser reads.
[[nodiscard]] Drift drift_of(const host::LaserFile& laser);

// Which random numbers: those of one campaign.
struct CampaignDraw {
  std::uint64_t seed = 1;
  std::uint32_t draw = 0;
};
// Set-ups of a campaign: each axis has its own number, its second set-up is this much farther on.
inline constexpr std::uint32_t kSecondSetUp = 100;
inline constexpr std::uint32_t kBallBarSetUp = 1000;  // the first of three

// How much warmer the machine is at the check than at the squareness, K.
[[nodiscard]] double check_temperature(const NoiseClasses& classes, const CampaignDraw& draw);

}  // namespace volcomp::sim
