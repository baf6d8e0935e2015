#pragma once
// Constants of the simulated grinder and its gear. The paper publishes no error of its machine: the
// amplitudes are chosen so that the sums reach its deviations. The run shows a mechanism, it
// verifies no experiment (docs/papers/internal-helical.md, "What stays open").
//
// Of the two random parts of C, 7 µrad belong to the slot and 5.5 µrad to the pass, both seen by
// the encoder. Neighbouring slots are ground in opposite directions, else learning C alone could
// not raise f_p to 86 µm.

#include "comp/core/units.hpp"

namespace volcomp::internal_helical {

inline constexpr double kRadPerDegree = kPi / 180.0;

inline constexpr double kStrokeTick_s = 2e-3;

struct GrindingTruth {
  // Position loops and what disturbs them.
  double gain_z = 83.3;  // 1/s
  double gain_c = (1.0 - 0.034) * 83.3;
  double ripple_mm = 9e-3;  // of Z, at this wavelength; its zero is at mid face
  double ripple_wavelength_mm = 2.5;
  double visible_rad = 44e-6;     // of C once per turn, seen by the encoder
  double slot_rms_rad = 7e-6;     // of C, another one for every slot, the same in every pass
  double pass_rms_rad = 5.5e-6;   // of C, another one for every pass
  double hunting_rms_mm = 3e-3;   // of X, another one for every pass
  double resolution_z_mm = 1e-4;  // of the encoders; X as Z
  double resolution_c_rad = 1e-4 * kRadPerDegree;

  // What no encoder of the machine sees.
  double invisible_rad = 70e-6;   // of C once per turn
  double runout_mm = 7e-3;        // of the workpiece
  double wheel_form_mm = 6.2e-3;  // slope of the wheel, on the profile from tip to form circle

  // Angles of the waves once per turn, slot 0 at 0: chosen so that F_p of the two flanks differ as
  // the deviations of the paper do.
  double visible_phase = 120.0 * kRadPerDegree;  // against the invisible one
  double runout_phase = 0.0;                     // direction in the frame of the gear

  double probe_mm = 0.25e-3;  // of the measuring machine, per point

  // Every pass like the one before, and a measuring machine without scatter: what repeats stays.
  void take_noise_away() { pass_rms_rad = hunting_rms_mm = probe_mm = 0.0; }
};

}  // namespace volcomp::internal_helical
