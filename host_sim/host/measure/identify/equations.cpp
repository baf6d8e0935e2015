#include "host_sim/host/measure/identify/equations.hpp"

#include <cmath>

namespace volcomp::host::identify {
namespace {

double value_at(const std::optional<Index>& at, const VectorXd& x) { return at ? x(*at) : 0.0; }

Vec3 vector_at(const std::optional<Index>& at, const VectorXd& x) {
  return at ? Vec3(x.segment<3>(*at)) : Vec3(Vec3::Zero());
}

// Error of a slide that has grown by 1, body value: it goes farther than its scale says.
double grown(const Problem& problem, std::size_t axis, double q) {
  return problem.machine.chain.axis(axis).sign * q;
}

Index along(const Problem& problem, std::size_t axis) {
  return static_cast<Index>(problem.machine.chain.axis(axis).axis);
}

}  // namespace

Circumstances Equations::circumstances(std::size_t setup, std::size_t i, const Estimate& e) const {
  const SetUp& s = problem_.setups[setup];
  Circumstances at;
  at.q = s.q[i];
  at.errors = unknowns_.errors(s.q[i], s.d[i], e.x);
  if (!s.known.empty())
    for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a)
      at.errors.at(a) += s.known[i].at(a);
  for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a)
    if (const auto growth = unknowns_.setup_growth(setup, a))
      at.errors.at(a)(along(problem_, a)) += e.x(*growth) * grown(problem_, a, at.q.at(a));
  at.tip = problem_.machine.chain.tool_point();
  if (const auto stylus = problem_.stylus_of(s, i)) {
    at.tip = problem_.styli[*stylus].offset;
    at.tip_correction = vector_at(unknowns_.stylus(*stylus), e.x);
    at.tip_radius =
        problem_.styli[*stylus].radius + value_at(unknowns_.stylus_radius(*stylus), e.x);
  }
  at.kappa = value_at(unknowns_.setup_scale(setup), e.x);
  if (s.artefact) {
    const Artefact& artefact = problem_.artefacts[*s.artefact];
    const std::size_t sphere = s.sphere[i];
    at.sphere = artefact.spheres[sphere];
    if (const auto first = unknowns_.spheres(*s.artefact))
      at.sphere_correction = e.x.segment<3>(*first + 3 * static_cast<Index>(sphere));
    if (!artefact.radius.empty()) at.sphere_radius = artefact.radius[sphere];
    at.kappa += value_at(unknowns_.artefact_scale(*s.artefact), e.x);
  }
  at.placement = e.placement[setup];
  const Index local = unknowns_.local(setup);
  if (!s.has_pose())
    for (std::size_t k = 0; k < local_count(problem_, s); ++k)
      at.local.push_back(e.x(local + static_cast<Index>(k)));
  return at;
}

VectorXd Equations::row_of(std::size_t setup, std::size_t i, const Reading& reading,
                           const Circumstances& at) const {
  const SetUp& s = problem_.setups[setup];
  VectorXd row = VectorXd::Zero(unknowns_.size());
  for (std::size_t a = 0; a < problem_.machine.chain.axis_count(); ++a) {
    unknowns_.add_errors(a, at.q.at(a), s.d[i].at(a), reading.by_error.at(a), row);
    if (const auto growth = unknowns_.setup_growth(setup, a))
      row(*growth) += reading.by_error.at(a)(along(problem_, a)) * grown(problem_, a, at.q.at(a));
  }
  row.segment(unknowns_.local(setup), reading.by_local.cols()) += reading.by_local.transpose();
  if (const auto scale = unknowns_.setup_scale(setup)) row(*scale) += reading.by_kappa;
  if (const auto stylus = problem_.stylus_of(s, i)) {
    if (const auto tip = unknowns_.stylus(*stylus))
      row.segment<3>(*tip) += reading.by_tip.transpose();
    if (const auto radius = unknowns_.stylus_radius(*stylus)) row(*radius) += reading.by_tip_radius;
  }
  if (!s.artefact) return row;
  if (const auto spheres = unknowns_.spheres(*s.artefact))
    row.segment<3>(*spheres + 3 * static_cast<Index>(s.sphere[i])) += reading.by_sphere.transpose();
  if (const auto scale = unknowns_.artefact_scale(*s.artefact)) row(*scale) += reading.by_kappa;
  return row;
}

void Equations::visit_setup(std::size_t setup, const Estimate& e, const VisitReading& visit) const {
  const SetUp& s = problem_.setups[setup];
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const Circumstances at = circumstances(setup, i, e);
    const std::vector<Reading> readings = reading_of(problem_, s, at);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const std::size_t n = readings.size() * i + k;
      const double y = s.y.empty() ? 0.0 : s.y[n];
      visit({setup, i, k}, row_of(setup, i, readings[k], at) / s.sigma[n],
            (y - readings[k].y) / s.sigma[n]);
    }
  }
}

void Equations::visit_readings(const Estimate& e, const VisitReading& visit) const {
  for (std::size_t k = 0; k < problem_.setups.size(); ++k)
    visit_setup(k, e, visit);
}

void Equations::visit_styli(const Estimate& e, const VisitKnown& visit) const {
  VectorXd row = VectorXd::Zero(unknowns_.size());
  const auto about_zero = [&](Index at, double sigma) {
    row.setZero();
    row(at) = 1.0 / sigma;
    visit(row, -e.x(at) / sigma);
  };
  for (std::size_t s = 0; s < problem_.styli.size(); ++s) {
    const Stylus& stylus = problem_.styli[s];
    if (const auto at = unknowns_.stylus(s); at && std::isfinite(*stylus.place))
      for (Index k = 0; k < 3; ++k)
        about_zero(*at + k, *stylus.place);
    if (const auto at = unknowns_.stylus_radius(s); at && std::isfinite(*stylus.radius_prior))
      about_zero(*at, *stylus.radius_prior);
  }
}

void Equations::visit_lengths(std::size_t artefact, const Estimate& e,
                              const VisitKnown& visit) const {
  const Artefact& a = problem_.artefacts[artefact];
  const auto first = unknowns_.spheres(artefact);
  if (!first) return;
  const auto place = [&](std::size_t sphere) {
    return Vec3(a.spheres[sphere] + e.x.segment<3>(*first + 3 * static_cast<Index>(sphere)));
  };
  for (const Length& length : a.lengths) {
    const Vec3 way = place(length.b) - place(length.a);
    VectorXd row = VectorXd::Zero(unknowns_.size());
    row.segment<3>(*first + 3 * static_cast<Index>(length.b)) = way.normalized() / length.sigma;
    row.segment<3>(*first + 3 * static_cast<Index>(length.a)) = -way.normalized() / length.sigma;
    visit(row, (length.length - way.norm()) / length.sigma);
  }
}

// Spheres about their nominal places; where these are free, without moving as one body.
void Equations::visit_artefacts(const Estimate& e, const VisitKnown& visit) const {
  constexpr double kHeld_mm = 1e-6;
  for (std::size_t k = 0; k < problem_.artefacts.size(); ++k) {
    const Artefact& a = problem_.artefacts[k];
    const auto first = unknowns_.spheres(k);
    visit_lengths(k, e, visit);
    if (const auto scale = unknowns_.artefact_scale(k); scale && std::isfinite(*a.scale)) {
      VectorXd row = VectorXd::Zero(unknowns_.size());
      row(*scale) = 1.0 / *a.scale;
      visit(row, -e.x(*scale) / *a.scale);
    }
    if (!first) continue;
    const auto count = static_cast<Index>(a.spheres.size());
    if (std::isfinite(*a.place)) {
      for (Index i = 0; i < 3 * count; ++i) {
        VectorXd row = VectorXd::Zero(unknowns_.size());
        row(*first + i) = 1.0 / *a.place;
        visit(row, -e.x(*first + i) / *a.place);
      }
      continue;
    }
    Vec3 mean = Vec3::Zero();
    for (const Vec3& c : a.spheres)
      mean += c / static_cast<double>(count);
    double squares = 0.0;
    for (const Vec3& c : a.spheres)
      squares += (c - mean).squaredNorm() / static_cast<double>(count);
    const double sigma = kHeld_mm * std::sqrt(static_cast<double>(count));
    for (Index axis = 0; axis < 3; ++axis) {
      VectorXd way = VectorXd::Zero(unknowns_.size());
      VectorXd turn = VectorXd::Zero(unknowns_.size());
      for (Index j = 0; j < count; ++j) {
        way.segment<3>(*first + 3 * j) = Vec3::Unit(axis) / sigma;
        const Vec3 arm = a.spheres[static_cast<std::size_t>(j)] - mean;
        turn.segment<3>(*first + 3 * j) =
            Vec3::Unit(axis).cross(arm) / (sigma * std::sqrt(squares));
      }
      visit(way, -way.dot(e.x));
      visit(turn, -turn.dot(e.x));
    }
  }
}

// 20 µm and 50 µrad of every coefficient and single value of the machine, 1 m, 1 rad and 1 % of all
// that is not of the machine.
void Equations::visit_weak(const Estimate& e, const VisitKnown& visit) const {
  constexpr double kWeak_mm = 20e-3;
  constexpr double kWeak_rad = 50e-6;
  constexpr double kNuisance_mm = 1000.0;
  constexpr double kNuisance_rad = 1.0;
  constexpr double kScale = 0.01;
  for (const VectorXd& row : unknowns_.coefficient_rows(kWeak_mm, kWeak_rad))
    visit(row, -row.dot(e.x));
  const auto about_zero = [&](Index at, double sigma) {
    VectorXd row = VectorXd::Zero(unknowns_.size());
    row(at) = 1.0 / sigma;
    visit(row, 0.0);
  };
  for (const Quantity& quantity : unknowns_.quantities()) {
    if (quantity.kind == QuantityKind::function) continue;
    Index at = 0;
    unknowns_.value_row(quantity, 0.0).maxCoeff(&at);
    about_zero(at, quantity.angular() ? kWeak_rad : kWeak_mm);
  }
  std::vector<bool> is_scale(static_cast<std::size_t>(unknowns_.size()), false);
  const auto mark = [&](const std::optional<Index>& at) {
    if (at) is_scale[static_cast<std::size_t>(*at)] = true;
  };
  for (std::size_t k = 0; k < problem_.setups.size(); ++k) {
    mark(unknowns_.setup_scale(k));
    for (std::size_t a = 0; a < kMaxAxes; ++a)
      mark(unknowns_.setup_growth(k, a));
  }
  for (std::size_t k = 0; k < problem_.artefacts.size(); ++k)
    mark(unknowns_.artefact_scale(k));
  for (Index i = unknowns_.of_machine(); i < unknowns_.size(); ++i) {
    const bool scale = is_scale[static_cast<std::size_t>(i)];
    about_zero(i, scale ? kScale : unknowns_.is_angle(i) ? kNuisance_rad : kNuisance_mm);
  }
}

void Equations::visit_known(const Estimate& e, const KnownBefore& which,
                            const VisitKnown& visit) const {
  if (which.places) visit_styli(e, visit);
  visit_artefacts(e, visit);
  for (std::size_t k = 0; k < problem_.setups.size(); ++k) {
    const SetUp& s = problem_.setups[k];
    const auto about = [&](double value, Index at, double sigma) {
      VectorXd row = VectorXd::Zero(unknowns_.size());
      row(at) = 1.0 / sigma;
      visit(row, (value - e.x(at)) / sigma);
    };
    const auto about_zero = [&](Index at, double sigma) { about(0.0, at, sigma); };
    if (which.places && s.kind == ObservationKind::tracer && s.station_prior &&
        std::isfinite(*s.station_prior))
      for (Index c = 0; c < 3; ++c)
        about((*s.station)(c), unknowns_.local(k) + c, *s.station_prior);
    if (s.scale && std::isfinite(*s.scale)) about_zero(*unknowns_.setup_scale(k), *s.scale);
    for (std::size_t a = 0; a < kMaxAxes; ++a)
      if (const auto growth = unknowns_.setup_growth(k, a); growth && std::isfinite(*s.growth))
        about_zero(*growth, *s.growth);
    if (s.kind == ObservationKind::bar && s.length_prior && std::isfinite(*s.length_prior))
      about_zero(unknowns_.local(k) + 2, *s.length_prior);
  }
  for (const VectorXd& row : unknowns_.curvature_rows())
    visit(row, -row.dot(e.x));
  if (which.weak) visit_weak(e, visit);
}

void Equations::move(const VectorXd& step, Estimate& e) const {
  e.x += step;
  for (std::size_t k = 0; k < problem_.setups.size(); ++k) {
    if (!problem_.setups[k].has_pose()) continue;
    const Index local = unknowns_.local(k);
    e.placement[k].R = exponential(step.segment<3>(local)) * e.placement[k].R;
    e.placement[k].t += step.segment<3>(local + 3);
    e.x.segment<6>(local).setZero();
  }
}

}  // namespace volcomp::host::identify
