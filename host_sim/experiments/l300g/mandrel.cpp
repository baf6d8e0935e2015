#include "host_sim/experiments/l300g/mandrel.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include "comp/metrology/fits/effective_radius.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/sim/artefacts/mandrel.hpp"

namespace volcomp::l300g {
namespace {

constexpr int kSteps = 81;
constexpr double kStep_mm = 0.2;
constexpr double kEffectiveBall_mm = 1.4935;  // of the paper: where the constellation lies
constexpr double kAround_mm = 25.0;           // past the mandrel from above to below
// The last touches are 76° off the normal: an error of 0.05 mm in Y is 0.2 mm there.
constexpr double kStandOff_mm = 1.0;

double square(double x) { return x * x; }

using Readings = std::pair<std::vector<double>, std::vector<double>>;  // y, z

// --- touching

Pose pose_at(const GrinderGeometry& g, double y, double z) {
  Pose q{};
  host::require(arm_angle(g.arm, z, q[2]), "mandrel");
  q[0] = g.datum.x - arm_foreshortening(g.arm, q[2]);
  q[1] = g.datum.y + y;
  return q;
}

Readings touch_all(Grinder& grinder) {
  Readings readings;
  const GrinderGeometry& g = grinder.geometry();
  const double probing = 5.0 / g.arm.length;
  const sim::ProbingFeeds feeds{50.0, probing, 4.0 * probing};
  bool above = true;
  for (const Transverse& centre : mandrel_centres()) {
    const double outwards = centre.z > 0.0 ? 1.0 : -1.0;
    if (above && outwards < 0.0) {
      grinder.go(pose_at(g, kAround_mm, centre.z), feeds.rapid);
      above = false;
    }
    const Pose from = pose_at(g, centre.y, centre.z + outwards * kStandOff_mm);
    const Pose beyond = pose_at(g, centre.y, centre.z - outwards * kStandOff_mm);
    Pose swung = beyond;  // B alone moves
    swung[0] = from[0];
    const sim::NodePoint point = grinder.prober().touch(from, swung, Vec3::Zero(), feeds);
    readings.first.push_back(g.datum.y + point.workpiece.y());
    readings.second.push_back(point.workpiece.z());
  }
  grinder.go(pose_at(g, kAround_mm, -kMandrelRadius_mm), feeds.rapid);
  grinder.go(grinder.clear_of_work(kFarAway_mm), feeds.rapid);
  return readings;
}

// Section 3, "Uncertainty". The square of the height enters R_c; about zero it is the square of the
// uncertainty that counts.
double uncertainty_of(const MandrelCalibration& c, const MandrelBudget& b, const SwingArm& arm) {
  const double touch = std::max(b.repeatability, c.fit.rms);
  const double by_arm = effect_of_arm(arm, b.arm_length).radius;
  const double by_pivot = effect_of_pivot(arm, b.pivot_height).radius;
  return std::sqrt(square(touch) * c.fit.cofactors(2, 2) + square(by_arm) + square(b.mandrel) +
                   square(by_pivot));
}

// --- what the fit makes of another machine

using BelievedHeight = std::function<double(double true_z)>;

MandrelEffect effect_on_fit(const BelievedHeight& believed) {
  std::vector<double> y;
  std::vector<double> z;
  for (const Transverse& centre : mandrel_centres()) {
    y.push_back(centre.y);
    z.push_back(believed(centre.z));
  }
  CircleFit fit;
  host::require(fit_circle(y, z, fit), "mandrel");
  return {fit.geometric.radius - kMandrelRadius_mm - kEffectiveBall_mm, fit.geometric.y,
          fit.geometric.z, fit.rms};
}

}  // namespace

std::vector<Transverse> mandrel_centres() {
  const double radius = kMandrelRadius_mm + kEffectiveBall_mm;
  std::vector<Transverse> centres;
  centres.reserve(std::size_t{2} * kSteps);
  for (int k = 0; k < kSteps; ++k)
    centres.push_back({k * kStep_mm, std::sqrt(square(radius) - square(k * kStep_mm))});
  for (int k = kSteps - 1; k >= 0; --k)
    centres.push_back({k * kStep_mm, -centres[static_cast<std::size_t>(k)].z});
  return centres;
}

double MandrelCalibration::residual(std::size_t i) const {
  const Circle& c = fit.geometric;
  return std::hypot(y[i] - c.y, z[i] - c.z) - c.radius;
}

MandrelEffect effect_of_arm(const SwingArm& arm, double longer) {
  const double scale = 1.0 + longer / arm.length;
  return effect_on_fit([scale](double z) { return scale * z; });
}

// Z = L (sin(θ + u) − sin u), u = −asin(H / L): at θ = 0 the ball is level with the axis of A.
MandrelEffect effect_of_pivot(const SwingArm& arm, double higher) {
  const double u = -std::asin(higher / arm.length);
  return effect_on_fit([&arm, u](double z) {
    const double theta = std::asin(z / arm.length + std::sin(u)) - u;
    return arm.length * std::sin(theta);
  });
}

MandrelCalibration mandrel_calibration(std::vector<double> y, std::vector<double> z,
                                       const MandrelBudget& budget, const SwingArm& arm) {
  MandrelCalibration result;
  result.y = std::move(y);
  result.z = std::move(z);
  host::require(fit_circle(result.y, result.z, result.fit), "mandrel calibration");
  EffectiveRadius effective;
  host::require(effective_radius(result.y, result.z, result.fit,
                                 {kMandrelRadius_mm, kNominalBall_mm}, effective),
                "mandrel calibration");
  result.rc = effective.rc;
  result.u_rc = uncertainty_of(result, budget, arm);
  return result;
}

MandrelCalibration calibrate_on_mandrel(Grinder& grinder, const MandrelBudget& budget, Mounted as) {
  const sim::Mandrel mandrel(kMandrelRadius_mm);
  grinder.mount(mandrel, as);
  Readings readings = touch_all(grinder);
  return mandrel_calibration(std::move(readings.first), std::move(readings.second), budget,
                             grinder.geometry().arm);
}

}  // namespace volcomp::l300g
