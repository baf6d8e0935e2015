#pragma once
// The lever experiments of the paper (its section 3.2): positioning of X measured at several places
// differs, and agrees once every reading is carried to one point by the measured angles.

#include <array>
#include <vector>

#include "host_sim/experiments/xyfz/bench.hpp"

namespace volcomp::xyfz {

struct LeverExperiment {
  const char* name = "";
  std::size_t angle = 0;    // that makes the readings differ: 0 EBX, 1 ECX, as in LeverTest
  std::vector<Vec3> place;  // reading head to sensed point at machine zero, mm
  Vec3 carried_to = Vec3::Zero();
  double paper_um = 0.0;  // within which the paper's readings agree

  // From the first place to the last, with the sign that the angle gives it; mm.
  [[nodiscard]] double lever_mm() const;
};

// Heights 250, 430 and 550 mm carried to the reading head (Fig. 8), and 0 and 290 mm sideways
// carried to the first of the two (Fig. 11).
[[nodiscard]] std::array<LeverExperiment, 2> lever_experiments();

// What is not perfect.
enum class LeverNoise : std::uint8_t {
  none,
  instrument,   // laser, its drift, and repeatability of the machine
  temperature,  // the same, and X is as warm as it happens to be at every set-up
};
inline constexpr std::size_t kLeverNoises = 3;

// Mean of all runs by place and target of the machine file, µm, zero at the reference target.
using LeverCurves = std::vector<std::vector<double>>;

struct LeverReadings {
  std::vector<double> position_mm;
  LeverCurves measured;
  LeverCurves carried;
  double found_mm = 0.0;     // LeverExperiment::lever_mm() as the lever self-test finds it
  Reason test = Reason::ok;  // of that; lever_spread_too_small: too much noise for these angles

  // The largest difference between two places at any target, µm.
  [[nodiscard]] double measured_apart_um() const;
  [[nodiscard]] double carried_apart_um() const;
};

// Number `draw` of options.seed: a function of these two, the experiment and the noise. One
// instrument measures at all places: its scale, gains and roll are the same there, what belongs to
// a set-up is not.
[[nodiscard]] LeverReadings measure_levers(const Bench& bench, const LeverExperiment& experiment,
                                           LeverNoise noise, std::size_t draw);

}  // namespace volcomp::xyfz
