#pragma once
// Calibrating the probe on a mandrel: effective radius and origin from one half plane of touches
// (docs/papers/l300g.md, "What we do"; the constellation of the paper's section 2.1).

#include <vector>

#include "comp/metrology/fits/circle_fit.hpp"
#include "host_sim/experiments/l300g/grinder.hpp"

namespace volcomp::l300g {

inline constexpr double kMandrelRadius_mm = 15.0;
inline constexpr double kNominalBall_mm = 1.5;

// What a standard uncertainty of r_c is made of besides the fit, mm. Assumed, not found: the paper
// gives none.
struct MandrelBudget {
  double repeatability = 0.3e-3;  // of a touch
  double mandrel = 0.2e-3;        // of its radius
  double arm_length = 1.0e-3;     // "known to about 1 µm for the digits printed"
  double pivot_height = 0.1;      // of the pivot above the axis of A, which counts as 0
};

struct MandrelCalibration {
  std::vector<double> y;  // readings of the ball centre: Y of the machine, height of the arm, mm
  std::vector<double> z;
  CircleFit fit;
  double rc = 0.0;    // R_c − R: of the mandrel, not of the ball
  double u_rc = 0.0;  // standard

  [[nodiscard]] double residual(std::size_t i) const;
};

// Where the ball centre is in the touches, from the centre of the mandrel: 81 above it, outwards,
// then 81 below, inwards, 0.2 mm apart in Y.
[[nodiscard]] std::vector<Transverse> mandrel_centres();

// From readings of all these touches. Throws UserError when the radius comes out implausible:
// outside (0, r_b + 0.05).
[[nodiscard]] MandrelCalibration mandrel_calibration(std::vector<double> y, std::vector<double> z,
                                                     const MandrelBudget& budget,
                                                     const SwingArm& arm);

// By touching all of them.
[[nodiscard]] MandrelCalibration calibrate_on_mandrel(Grinder& grinder, const MandrelBudget& budget,
                                                      Mounted as = Mounted::mandrel);

// Change of the fit when the machine differs from its model, mm.
struct MandrelEffect {
  double radius = 0.0;
  double y0 = 0.0;
  double z0 = 0.0;
  double rms = 0.0;
};
// The model has the arm longer than it is.
[[nodiscard]] MandrelEffect effect_of_arm(const SwingArm& arm, double longer);
// The pivot is higher than the axis of A, which the model does not have.
[[nodiscard]] MandrelEffect effect_of_pivot(const SwingArm& arm, double higher);

}  // namespace volcomp::l300g
