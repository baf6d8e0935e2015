#include "host_sim/host/measure/probe_calibration.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/LU>

#include "comp/core/units.hpp"
#include "comp/metrology/fits/circle_fit.hpp"
#include "comp/metrology/fits/lobing_fit.hpp"
#include "comp/metrology/fits/sphere_fit.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kMostRadius_mm = kMaxBallRadius_nm / kNmPerMm;
constexpr double kMostResidual_mm = 0.05;  // lobing is below; a slip of the artefact is not
constexpr std::size_t kSpareTouches = 4;   // beyond the parameters, for their uncertainty
// Standard deviation of a fitted radius over that of a touch: beyond it the touches lie too close
// together to separate radius, place and lobes.
constexpr double kMostGain = 10.0;
constexpr int kMostMoves = 50;
constexpr double kAtRest_mm = 1e-9;

// Mean radius of the centres about their middle, and what is known of its quality.
struct FittedPlace {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  double rms = 0.0;
  double largest = 0.0;
  std::size_t worst = 0;
  double radius_cofactor = 0.0;
  std::size_t parameters = 0;
};

// What a touch shows about a supposed place of the artefact.
struct ShownRadii {
  std::vector<Vec3> outwards;   // unit, from the place to the ball, coordinates of the touches
  std::vector<Vec3> direction;  // in which the ball is pushed, tool frame
  std::vector<double> radius;   // of the ball, mm
};

class ProbeCalibrator {
 public:
  ProbeCalibrator(const TouchFile& file, const ProbeArtefact& artefact)
      : file_(file), artefact_(artefact), axis_(static_cast<Eigen::Index>(artefact.ring_axis)) {}

  [[nodiscard]] FittedPlace place() const { return is_ring() ? circle() : sphere(); }

  [[nodiscard]] double ball_radius(double found) const {
    return sense() * (found - 0.5 * artefact_.diameter_mm);
  }

  [[nodiscard]] ShownRadii shown_about(const Vec3& centre) const {
    ShownRadii shown;
    for (const ProbeTouch& touch : file_.touches) {
      Vec3 way = touch.centre - centre;
      if (is_ring()) way(axis_) = 0.0;
      const double distance = way.norm();
      if (!(distance > 0.0))
        throw UserError(fmt::format("{}:{}: the touch is in the middle of the artefact", file_.name,
                                    touch.line));
      shown.outwards.emplace_back(way / distance);
      shown.direction.push_back(file_.has_normals ? touch.normal
                                                  : Vec3(sense() * shown.outwards.back()));
      shown.radius.push_back(ball_radius(distance));
    }
    return shown;
  }

  // Where the artefact is if the terms of first order are its shift: least squares over the
  // touches, exact where the tool has not turned.
  [[nodiscard]] Vec3 shift(const ShownRadii& shown, const LobingMap& map) const {
    Mat3 normal = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    const Vec3 first(map.coefficient[1], map.coefficient[2], map.coefficient[3]);
    for (std::size_t i = 0; i < shown.outwards.size(); ++i) {
      normal += shown.outwards[i] * shown.outwards[i].transpose();
      right += sense() * shown.outwards[i] * first.dot(shown.direction[i]);
    }
    if (is_ring()) normal(axis_, axis_) += 1.0;
    return normal.inverse() * right;
  }

  [[nodiscard]] bool is_ring() const { return artefact_.shape == ArtefactShape::ring; }

 private:
  [[nodiscard]] double sense() const { return is_ring() ? -1.0 : 1.0; }

  [[nodiscard]] FittedPlace sphere() const {
    std::vector<Vec3> centres;
    for (const ProbeTouch& touch : file_.touches)
      centres.push_back(touch.centre);
    SphereFit fit;
    require_fit(fit_sphere(centres, fit));
    return {fit.sphere.centre, fit.sphere.radius,   fit.rms, fit.largest,
            fit.worst,         fit.cofactors(3, 3), 4};
  }

  [[nodiscard]] FittedPlace circle() const {
    const Eigen::Index u = (axis_ + 1) % 3;
    const Eigen::Index v = (axis_ + 2) % 3;
    std::vector<double> along_u;
    std::vector<double> along_v;
    double height = 0.0;
    for (const ProbeTouch& touch : file_.touches) {
      along_u.push_back(touch.centre(u));
      along_v.push_back(touch.centre(v));
      height += touch.centre(axis_) / static_cast<double>(file_.touches.size());
    }
    CircleFit fit;
    require_fit(fit_circle(along_u, along_v, fit));
    FittedPlace place{Vec3::Zero(), fit.geometric.radius, fit.rms, fit.largest,
                      fit.worst,    fit.cofactors(2, 2),  3};
    place.centre(u) = fit.geometric.y;
    place.centre(v) = fit.geometric.z;
    place.centre(axis_) = height;
    return place;
  }

  void require_fit(const Status& status) const {
    const bool in_plane = status.reason == Reason::rank_deficient;
    if (in_plane)
      throw UserError(file_.name + ": the touches lie in a plane and do not show a sphere");
    require(status, file_.name);
  }

  const TouchFile& file_;
  ProbeArtefact artefact_;
  Eigen::Index axis_;
};

void require_touches(const TouchFile& file, std::size_t parameters, ProbeModel model) {
  const std::size_t needed = parameters + kSpareTouches;
  if (file.touches.size() >= needed) return;
  throw UserError(fmt::format("{}: {} touches, {} parameters need at least {}{} [{}]", file.name,
                              file.touches.size(), parameters, needed,
                              model == ProbeModel::lobing ? "; a constant radius needs fewer" : "",
                              code(Reason::too_few_points)));
}

void require_spread(const TouchFile& file, double cofactor) {
  if (std::sqrt(cofactor) <= kMostGain) return;
  throw UserError(fmt::format(
      "{}: the touches cover too little of the artefact: the radius is {:.0f} times less certain "
      "than a touch",
      file.name, std::sqrt(cofactor)));
}

void require_plausible(const TouchFile& file, const ProbeCalibration& c) {
  const double radius = c.radius.coefficient[0];
  if (!(radius > 0.0 && radius < kMostRadius_mm))
    throw UserError(
        fmt::format("{}: the effective radius comes out as {:.4f} mm, a ball has from 0 to {:g}: "
                    "is the diameter of the artefact right, and its kind? [{}]",
                    file.name, radius, kMostRadius_mm, code(Reason::implausible_radius)));
  if (std::abs(c.largest) > kMostResidual_mm)
    throw UserError(fmt::format("{}:{}: the touch is {:.4f} mm off the fit, more than {:g} mm [{}]",
                                file.name, c.worst_line, c.largest, kMostResidual_mm,
                                code(Reason::residuals_too_large)));
}

void note_range(const ShownRadii& shown, ProbeCalibration& c) {
  c.least_radius = c.most_radius = c.radius.radius(shown.direction[0]);
  for (const Vec3& d : shown.direction) {
    c.least_radius = std::min(c.least_radius, c.radius.radius(d));
    c.most_radius = std::max(c.most_radius, c.radius.radius(d));
  }
}

// Standard uncertainties: from the residuals, and from the certificate. A diameter stated as ± U (k
// = 2) is U/4 of the radius.
void set_uncertainty(double cofactor, const ProbeArtefact& artefact, ProbeCalibration& c) {
  const double certificate = artefact.expanded_um.value_or(0.0) / (4.0 * kUmPerMm);
  c.u_effective = std::hypot(c.repeatability * std::sqrt(cofactor), certificate);
  // The mean of the variances of fitted values is the share of the parameters in the touches.
  const double share = static_cast<double>(c.parameters) / static_cast<double>(c.touches);
  c.u_map = std::hypot(c.repeatability * std::sqrt(share), certificate);
}

ProbeCalibration constant_radius(const ProbeCalibrator& calibrator, const TouchFile& file,
                                 const ProbeArtefact& artefact, const FittedPlace& place) {
  require_touches(file, place.parameters, ProbeModel::constant);
  require_spread(file, place.radius_cofactor);
  ProbeCalibration c;
  c.touches = file.touches.size();
  c.parameters = place.parameters;
  c.known = 1;
  c.centre = place.centre;
  c.radius.coefficient[0] = c.least_radius = c.most_radius = calibrator.ball_radius(place.radius);
  c.repeatability = place.rms;
  c.largest = place.largest;
  c.worst_line = file.touches[place.worst].line;
  set_uncertainty(place.radius_cofactor, artefact, c);
  c.u_map = c.u_effective;  // one radius for all directions
  return c;
}

ProbeCalibration lobing_map(const ProbeCalibrator& calibrator, const TouchFile& file,
                            const ProbeArtefact& artefact, const FittedPlace& place) {
  ProbeCalibration c;
  c.touches = file.touches.size();
  c.centre = place.centre;
  LobingFit fit;
  ShownRadii shown;
  for (int move = 0; move < kMostMoves; ++move) {
    shown = calibrator.shown_about(c.centre);
    require(fit_lobing(shown.direction, shown.radius, fit), file.name);
    const Vec3 shift = calibrator.shift(shown, fit.map);
    if (!(shift.norm() > kAtRest_mm)) break;
    c.centre += shift;
  }
  c.parameters = static_cast<std::size_t>(fit.rank);  // its first order is the place
  require_touches(file, c.parameters, ProbeModel::lobing);
  require_spread(file, std::max(place.radius_cofactor, fit.cofactor[0]));
  c.radius = fit.map;
  c.known = fit.known;
  if (!file.has_normals) {
    for (std::size_t k = 1; k <= 3; ++k)
      c.radius.coefficient.at(k) = 0.0;
    c.known &= ~0xEU;
  }
  c.repeatability = fit.rms;
  c.largest = fit.largest;
  c.worst_line = file.touches[fit.worst].line;
  note_range(shown, c);
  set_uncertainty(fit.cofactor[0], artefact, c);
  return c;
}

}  // namespace

ProbeCalibration calibrate_probe(const TouchFile& file, const ProbeArtefact& artefact,
                                 ProbeModel model) {
  const ProbeCalibrator calibrator(file, artefact);
  const FittedPlace place = calibrator.place();
  ProbeCalibration c = model == ProbeModel::constant
                           ? constant_radius(calibrator, file, artefact, place)
                           : lobing_map(calibrator, file, artefact, place);
  require_plausible(file, c);
  return c;
}

}  // namespace volcomp::host
