// Where the estimate begins: see Equations::start().

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "host_sim/host/measure/identify/equations.hpp"

namespace volcomp::host::identify {
namespace {

Vec3 ideal_tip(const Problem& problem, const SetUp& s, std::size_t i) {
  return ideal_geometry(problem.machine.chain, s.q[i]).in_work(problem.tip_of(s, i));
}

// The rigid motion that brings the spheres nearest to where they were found.
Placement measured_placement(const Problem& problem, const SetUp& s) {
  Eigen::Matrix3Xd nominal(3, static_cast<Index>(s.q.size()));
  Eigen::Matrix3Xd found(3, static_cast<Index>(s.q.size()));
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const auto column = static_cast<Index>(i);
    nominal.col(column) = problem.artefacts[*s.artefact].spheres[s.sphere[i]];
    const bool measured = s.kind == ObservationKind::centre && !s.y.empty();
    found.col(column) =
        measured ? Vec3(s.y[3 * i], s.y[3 * i + 1], s.y[3 * i + 2]) : ideal_tip(problem, s, i);
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(nominal, found, false);
  return {motion.topLeftCorner<3, 3>(), motion.topRightCorner<3, 1>()};
}

}  // namespace

void Equations::start_setup(std::size_t setup, Estimate& e) const {
  const SetUp& s = problem_.setups[setup];
  const Index local = unknowns_.local(setup);
  if (s.has_pose()) e.placement[setup] = s.pose ? *s.pose : measured_placement(problem_, s);
  if (s.kind == ObservationKind::tracer) e.x.segment<3>(local) = *s.station;
  if (s.kind == ObservationKind::rtest) e.x.segment<3>(local) = ideal_tip(problem_, s, 0);
  if (s.y.empty() || s.has_pose() || s.kind == ObservationKind::rtest) return;
  // What is added to every reading of a channel: the last unknown, of runs the first ones.
  const std::size_t components = s.components();
  std::vector<double> mean(components, 0.0);
  visit_setup(setup, e, [&](const ReadingPlace& at, const VectorXd& /*row*/, double residual) {
    mean[at.component] += residual * s.sigma[components * at.observation + at.component] /
                          static_cast<double>(s.q.size());
  });
  const Index first = s.kind == ObservationKind::runs
                          ? local
                          : local + static_cast<Index>(local_count(problem_, s)) - 1;
  for (std::size_t k = 0; k < components; ++k)
    e.x(first + static_cast<Index>(k)) += mean[k];
}

// Only what the set-up has for itself, of least norm where that is not determined: touches and far
// stations may not converge without.
void Equations::settle_setup(std::size_t setup, Estimate& e) const {
  constexpr int kMostSteps = 10;
  constexpr double kSettled = 1e-7;
  const SetUp& s = problem_.setups[setup];
  const Index local = unknowns_.local(setup);
  const auto count = static_cast<Index>(local_count(problem_, s)) + (s.scale ? 1 : 0);
  const auto rows = static_cast<Index>(s.q.size() * s.components());
  for (int step = 0; step < kMostSteps; ++step) {
    MatrixXd J = MatrixXd::Zero(rows + 2, count);
    VectorXd r = VectorXd::Zero(rows + 2);
    Index n = 0;
    visit_setup(setup, e, [&](const ReadingPlace& /*at*/, const VectorXd& row, double residual) {
      J.row(n) = row.segment(local, count).transpose();
      r(n++) = residual;
    });
    if (s.scale && std::isfinite(*s.scale)) {
      J(n, count - 1) = 1.0 / *s.scale;
      r(n++) = -e.x(local + count - 1) / *s.scale;
    }
    if (s.kind == ObservationKind::bar && s.length_prior && std::isfinite(*s.length_prior)) {
      J(n, 2) = 1.0 / *s.length_prior;
      r(n) = -e.x(local + 2) / *s.length_prior;
    }
    VectorXd all = VectorXd::Zero(unknowns_.size());
    all.segment(local, count) = J.completeOrthogonalDecomposition().solve(r);
    move(all, e);
    if (all.cwiseAbs().maxCoeff() < kSettled) return;
  }
}

Estimate Equations::start() const {
  Estimate e;
  e.x = VectorXd::Zero(unknowns_.size());
  e.placement.resize(problem_.setups.size());
  for (std::size_t k = 0; k < problem_.setups.size(); ++k) {
    start_setup(k, e);
    const bool measured =
        !problem_.setups[k].y.empty() || problem_.setups[k].kind == ObservationKind::touch;
    if (measured) settle_setup(k, e);
  }
  return e;
}

Problem Equations::made_consistent(const Problem& problem) {
  Problem out = problem;
  const MachineChain& chain = problem.machine.chain;
  for (std::size_t k = 0; k < out.setups.size(); ++k) {
    SetUp& s = out.setups[k];
    s.y.clear();
    s.known.clear();
    if (!s.has_pose() && s.kind != ObservationKind::rtest) continue;
    const Placement pose = s.pose         ? *s.pose
                           : s.has_pose() ? measured_placement(problem, problem.setups[k])
                                          : Placement{};
    const Vec3 ball = ideal_tip(problem, s, 0);  // of an R-test
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      const Vec3 tip = ideal_tip(problem, s, i);
      Vec3 way = ball - tip;
      if (s.has_pose()) {
        const Artefact& a = problem.artefacts[*s.artefact];
        way = pose.R * a.spheres[s.sphere[i]] + pose.t - tip;
        if (s.kind == ObservationKind::touch) {
          const auto stylus = problem.stylus_of(s, i);
          const double apart =
              a.radius[s.sphere[i]] + (stylus ? problem.styli[*stylus].radius : 0.0);
          way *= 1.0 - apart / way.norm();
        }
      }
      move_by(chain, ideal_geometry(chain, s.q[i]), way, s.q[i]);
    }
    if (s.has_pose()) s.pose = pose;
  }
  return out;
}

}  // namespace volcomp::host::identify
