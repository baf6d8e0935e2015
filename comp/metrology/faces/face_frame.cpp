#include "comp/metrology/faces/face_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/SVD>

#include "comp/metrology/fits/fold_row.hpp"
#include "comp/probe/face_relief.hpp"

namespace volcomp {
namespace {

constexpr double kSettled_mm = 1e-7;
constexpr double kMostRms_mm = 0.020;
constexpr double kMostSigmas = 5.0;
constexpr double kVoid = 1e-6;  // of the largest singular value

using Six = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Triangle = Eigen::Matrix<double, 7, 7>;  // rows of the Jacobian, and the residual beside them

// Which coordinates, in the order of ErrorMotion.
struct Unknowns {
  std::array<Eigen::Index, 6> at;
  Eigen::Index count;
};

Unknowns unknowns_of(FrameFreedom freedom) {
  switch (freedom) {
    case FrameFreedom::turn:
      return {{5}, 1};
    case FrameFreedom::shift:
      return {{0, 1, 2}, 3};
    case FrameFreedom::plane:
      return {{0, 1, 5}, 3};
    case FrameFreedom::shift_turn:
      return {{0, 1, 2, 5}, 4};
    case FrameFreedom::all:
      break;
  }
  return {{0, 1, 2, 3, 4, 5}, 6};
}

Status refuse_at(Reason reason, std::size_t index) {
  Where where;
  where.index = static_cast<int>(index);
  return refuse(reason, where);
}

FaceFoot foot_of(const FaceGear& gear, const FaceFrameSettings& settings, const FaceFlank& flank,
                 const Vec3& p) {
  return settings.relieved ? distance_from_relieved_face(gear, flank, p)
                           : distance_from_face(gear, flank, p);
}

// The distance changes by n·shift and by (p × n)·turn.
Status fold(const FaceGear& gear, Span<const FaceTouchPoint> points,
            const FaceFrameSettings& settings, const Frame& frame, Triangle& triangle) {
  const Unknowns unknown = unknowns_of(settings.freedom);
  triangle.setZero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 p = frame.apply(points[k].centre);
    const FaceFoot foot = foot_of(gear, settings, points[k].flank, p);
    if (!has_distance(foot.reason)) return refuse_at(foot.reason, k);
    Six gradient;
    gradient << foot.normal, p.cross(foot.normal) / gear.r_pitch;
    Eigen::Matrix<double, 1, 7> row = Eigen::Matrix<double, 1, 7>::Zero();
    for (Eigen::Index i = 0; i < unknown.count; ++i)
      row(i) = gradient(unknown.at[static_cast<std::size_t>(i)]);
    row(6) = foot.distance - settings.ball_radius;
    fold_row<7>(triangle, row);
  }
  return {};
}

// Singular values and directions of the unknowns; turns in mm at the pitch radius.
class Solver {
 public:
  Solver(const Triangle& triangle, FrameFreedom freedom)
      : unknown_(unknowns_of(freedom)),
        svd_(Mat6(triangle.topLeftCorner<6, 6>()), Eigen::ComputeFullU | Eigen::ComputeFullV),
        right_(triangle.col(6).head<6>()) {}

  [[nodiscard]] int rank() const {
    int rank = 0;
    for (Eigen::Index i = 0; i < unknown_.count; ++i)
      rank += value(i) > kVoid * value(0) ? 1 : 0;
    return rank;
  }
  [[nodiscard]] bool complete() const { return rank() == unknown_.count; }

  // Shifts, and turns in mm.
  [[nodiscard]] Six step() const {
    const Six image = svd_.matrixU().transpose() * right_;
    Six reduced = Six::Zero();
    for (Eigen::Index i = 0; i < unknown_.count; ++i)
      reduced -= image(i) / value(i) * svd_.matrixV().col(i);
    Six full = Six::Zero();
    for (Eigen::Index i = 0; i < unknown_.count; ++i)
      full(unknown_.at[static_cast<std::size_t>(i)]) = reduced(i);
    return full;
  }

  [[nodiscard]] FaceObservability observability(double radius) const {
    FaceObservability out;
    out.rank = rank();
    out.condition = std::numeric_limits<double>::infinity();
    if (!complete()) return out;
    out.condition = value(0) / value(unknown_.count - 1);
    Mat6 reduced = Mat6::Zero();
    for (Eigen::Index i = 0; i < unknown_.count; ++i) {
      const Six direction = svd_.matrixV().col(i) / value(i);
      reduced += direction * direction.transpose();
    }
    for (Eigen::Index i = 0; i < unknown_.count; ++i) {
      for (Eigen::Index j = 0; j < unknown_.count; ++j) {
        const Eigen::Index a = unknown_.at[static_cast<std::size_t>(i)];
        const Eigen::Index b = unknown_.at[static_cast<std::size_t>(j)];
        out.cofactors(a, b) = reduced(i, j) / ((a < 3 ? 1.0 : radius) * (b < 3 ? 1.0 : radius));
      }
    }
    return out;
  }

 private:
  [[nodiscard]] double value(Eigen::Index i) const { return svd_.singularValues()(i); }

  Unknowns unknown_;
  Eigen::JacobiSVD<Mat6> svd_;
  Six right_;
};

Status check(Span<const FaceTouchPoint> points, const FaceFrameSettings& settings,
             Span<double> residuals) {
  if (!residuals.empty() && residuals.size() != points.size())
    return refuse(Reason::length_mismatch);
  Where where;
  where.field = "ball_radius";
  if (!(settings.ball_radius > 0.0)) return refuse(Reason::bad_setting, where);
  where.field = "sigma";
  if (!(settings.sigma > 0.0)) return refuse(Reason::bad_setting, where);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].centre.allFinite()) return refuse_at(Reason::not_finite, k);
  }
  return {};
}

bool both_sides(Span<const FaceTouchPoint> points) {
  return std::any_of(points.begin(), points.end(), [&](const FaceTouchPoint& p) {
    return p.flank.side * points[0].flank.side < 0.0;
  });
}

Status not_fixed(int rank) {
  Where where;
  where.count = rank;
  return refuse(Reason::frame_not_fixed, where);
}

// p ← Exp(turn) p + shift
void move(const Six& motion, Frame& frame) {
  const Mat3 turn =
      rotation_minus_identity(RotationModel::exponential, rotation(motion)) + Mat3::Identity();
  frame = Frame{turn, translation(motion)} * frame;
}

Status iterate(const FaceGear& gear, Span<const FaceTouchPoint> points,
               const FaceFrameSettings& settings, FaceFrame& fit) {
  for (fit.steps = 1; fit.steps <= kMaxFrameSteps; ++fit.steps) {
    Triangle triangle;
    if (const Status s = fold(gear, points, settings, fit.frame, triangle); !s.ok()) return s;
    const Solver solver(triangle, settings.freedom);
    if (!solver.complete()) return not_fixed(solver.rank());
    Six motion = solver.step();
    const double size = motion.norm();
    motion.tail<3>() /= gear.r_pitch;
    move(motion, fit.frame);
    fit.observability = solver.observability(gear.r_pitch);
    if (size < kSettled_mm) return {};
  }
  return refuse(Reason::residuals_too_large);
}

// What is left in the frame found; every foot has to be on its flank.
Status look_back(const FaceGear& gear, Span<const FaceTouchPoint> points,
                 const FaceFrameSettings& settings, FaceFrame& fit) {
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FaceFoot foot =
        foot_of(gear, settings, points[k].flank, fit.frame.apply(points[k].centre));
    if (foot.reason != Reason::ok) return refuse_at(foot.reason, k);
    const double rest = foot.distance - settings.ball_radius;
    sum += rest * rest;
    if (fit.worst >= 0 && std::abs(rest) <= std::abs(fit.largest)) continue;
    fit.largest = rest;
    fit.worst = static_cast<int>(k);
  }
  fit.rms = std::sqrt(sum / static_cast<double>(points.size()));
  if (fit.rms <= kMostRms_mm && std::abs(fit.largest) <= kMostSigmas * settings.sigma) return {};
  Where where;
  where.index = fit.worst;
  where.deviation = fit.largest;
  where.has_deviation = true;
  return refuse(Reason::outlier, where);
}

}  // namespace

std::size_t unknowns(FrameFreedom freedom) {
  return static_cast<std::size_t>(unknowns_of(freedom).count);
}

Status face_observability(const FaceGear& gear, Span<const FaceTouchPoint> points,
                          const FaceFrameSettings& settings, FaceObservability& out) {
  if (points.empty()) return refuse(Reason::too_few_points);
  Triangle triangle;
  if (const Status s = fold(gear, points, settings, Frame{}, triangle); !s.ok()) return s;
  out = Solver(triangle, settings.freedom).observability(gear.r_pitch);
  return {};
}

Status fit_face_frame(const FaceGear& gear, Span<const FaceTouchPoint> points,
                      const FaceFrameSettings& settings, Span<double> residuals, FaceFrame& out) {
  if (const Status s = check(points, settings, residuals); !s.ok()) return s;
  if (points.size() < unknowns(settings.freedom)) return not_fixed(static_cast<int>(points.size()));
  FaceFrame fit;
  if (const Status s = iterate(gear, points, settings, fit); !s.ok()) return s;
  if (settings.freedom == FrameFreedom::all && !both_sides(points))
    return not_fixed(fit.observability.rank);
  if (const Status s = look_back(gear, points, settings, fit); !s.ok()) return s;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const Vec3 p = fit.frame.apply(points[k].centre);
    residuals[k] = foot_of(gear, settings, points[k].flank, p).distance - settings.ball_radius;
  }
  out = fit;
  return {};
}

Eigen::Matrix<double, 6, 1> frame_deviations(const FaceGear& gear, const FaceObservability& at) {
  Six out = at.cofactors.diagonal().cwiseSqrt();
  out.tail<3>() *= gear.r_pitch;
  return out;
}

}  // namespace volcomp
