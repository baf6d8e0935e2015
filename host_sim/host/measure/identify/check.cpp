#include "host_sim/host/measure/identify/check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/SVD>

#include "host_sim/host/measure/identify/rank.hpp"

namespace volcomp::host::identify {
namespace {

Refusal refusal(Reason reason, const SetUp& s, const std::string& field = {}) {
  Refusal r;
  r.reason = reason;
  r.setup = s.name;
  r.field = field;
  return r;
}

Refusal placed(Refusal r, std::size_t index) {
  r.index = index;
  return r;
}

// The first set-up that is refused.
Refusal first_of(const Problem& problem, const std::function<Refusal(const SetUp&)>& check) {
  for (const SetUp& s : problem.setups)
    if (Refusal r = check(s); !r.ok()) return r;
  return {};
}

Refusal check_fields(const SetUp& s) {
  const auto missing = [&](const char* field) { return refusal(Reason::missing_field, s, field); };
  using Kind = ObservationKind;
  if (s.name.empty()) return missing("name");
  if (s.q.empty()) return missing("q");
  if (s.sigma.empty()) return missing("sigma");
  const bool station = s.kind == Kind::tracer || s.kind == Kind::bar;
  if (station && !s.station) return missing("station");
  if (s.kind == Kind::bar && !(s.length > 0.0)) return missing("length");
  const bool beam = s.kind == Kind::diagonal || s.kind == Kind::step;
  if (beam && !s.along) return missing("u");
  if (s.kind == Kind::step && !s.beam) return missing("beam");
  if (s.kind == Kind::step && !s.mirror) return missing("mirror");
  if (s.has_pose() && !s.artefact) return missing("artefact");
  if (s.has_pose() && s.sphere.empty()) return missing("sphere");
  if (s.kind == Kind::runs && s.channels.empty()) return missing("channels");
  return {};
}

Refusal check_parts(const Problem& problem) {
  Refusal r;
  r.reason = Reason::missing_field;
  r.field = problem.styli.empty() ? "styli" : "setups";
  return problem.styli.empty() || problem.setups.empty() ? r : Refusal{};
}

Refusal check_names(const Problem& problem) {
  Refusal r;
  r.reason = Reason::duplicate_id;
  const auto twice = [](const auto& list, std::string& where) {
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (list[i].name == list[j].name) {
          where = list[i].name;
          return true;
        }
    return false;
  };
  const bool found = twice(problem.styli, r.stylus) || twice(problem.artefacts, r.artefact) ||
                     twice(problem.setups, r.setup);
  return found ? r : Refusal{};
}

Refusal check_references(const Problem& problem, const SetUp& s) {
  const auto unknown = [&](const char* field) {
    return refusal(Reason::unknown_reference, s, field);
  };
  for (const std::size_t stylus : s.stylus)
    if (stylus >= problem.styli.size()) return unknown("stylus");
  if (s.artefact) {
    if (*s.artefact >= problem.artefacts.size()) return unknown("artefact");
    for (const std::size_t sphere : s.sphere)
      if (sphere >= problem.artefacts[*s.artefact].spheres.size()) return unknown("sphere");
    // A touch is held against the surface of its ball.
    const Artefact& artefact = problem.artefacts[*s.artefact];
    if (s.kind == ObservationKind::touch && artefact.radius.size() != artefact.spheres.size())
      return refusal(Reason::missing_field, s, "radius");
  }
  const std::size_t axes = problem.machine.chain.axis_count();
  return s.kind == ObservationKind::runs && s.axis >= axes ? unknown("axis") : Refusal{};
}

Refusal check_lengths(const SetUp& s) {
  const auto mismatch = [&](const char* field) {
    return refusal(Reason::length_mismatch, s, field);
  };
  const std::size_t readings = s.q.size() * s.components();
  if (!s.y.empty() && s.y.size() != readings) return mismatch("y");
  if (s.d.size() != s.q.size()) return mismatch("d");
  if (s.has_pose() && s.sphere.size() != s.q.size()) return mismatch("sphere");
  if (!s.stylus.empty() && s.stylus.size() != s.q.size()) return mismatch("stylus");
  return s.sigma.size() != readings ? mismatch("sigma") : Refusal{};
}

Refusal check_finite(const Problem& problem) {
  for (const Stylus& stylus : problem.styli) {
    if (stylus.offset.allFinite()) continue;
    Refusal r;
    r.reason = Reason::not_finite;
    r.stylus = stylus.name;
    return r;
  }
  const std::size_t axes = problem.machine.chain.axis_count();
  return first_of(problem, [&](const SetUp& s) {
    for (std::size_t i = 0; i < s.q.size(); ++i)
      for (std::size_t a = 0; a < axes; ++a)
        if (!std::isfinite(s.q[i].at(a))) return placed(refusal(Reason::not_finite, s, "q"), i);
    for (std::size_t n = 0; n < s.y.size(); ++n)
      if (!std::isfinite(s.y[n]))
        return placed(refusal(Reason::not_finite, s, "y"), n / s.components());
    if (s.station && !s.station->allFinite()) return refusal(Reason::not_finite, s, "station");
    if (s.pose && !(s.pose->R.allFinite() && s.pose->t.allFinite()))
      return refusal(Reason::not_finite, s, "pose");
    return Refusal{};
  });
}

Refusal check_sigma(const SetUp& s) {
  const bool good = std::all_of(s.sigma.begin(), s.sigma.end(), [](double v) { return v > 0.0; });
  return good ? Refusal{} : refusal(Reason::sigma_not_positive, s);
}

Refusal check_reference_stylus(const Problem& problem) {
  const bool runs_alone =
      std::all_of(problem.setups.begin(), problem.setups.end(),
                  [](const SetUp& s) { return s.kind == ObservationKind::runs; });
  const auto fixed = std::count_if(problem.styli.begin(), problem.styli.end(),
                                   [](const Stylus& s) { return !s.place; });
  Refusal r;
  r.reason = Reason::reference_stylus;
  return runs_alone || fixed == 1 ? Refusal{} : r;
}

Refusal check_travel(const Problem& problem, const SetUp& s) {
  constexpr double kRounding = 1e-6;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
      if (s.kind == ObservationKind::runs && a != s.axis) continue;
      const Travel& travel = problem.machine.travel.at(a);
      const double q = s.q[i].at(a);
      if (q >= travel.lo - kRounding && q <= travel.hi + kRounding) continue;
      Refusal r = placed(refusal(Reason::position_out_of_range, s), i);
      r.axis = problem.machine.name_of(a);
      return r;
    }
  }
  return {};
}

Vec3 ideal_point(const Problem& problem, const SetUp& s, std::size_t i) {
  const Vec3 tip = problem.tip_of(s, i);
  const ChainGeometry g = ideal_geometry(problem.machine.chain, s.q[i]);
  return s.in_bed ? g.tool.apply(tip) : g.in_work(tip);
}

// How far a component is from what an ideal machine would have read, but for what is added to all.
struct Plausible {
  std::vector<double> off;
  bool about_median = false;
  double limit = 0.0;
};

Plausible plausible(const Problem& problem, const SetUp& s) {
  constexpr double kNear_mm = 5.0;
  constexpr double kTracer_mm = 105.0;
  Plausible p{s.y, false, kNear_mm};
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    if (s.kind == ObservationKind::tracer) {
      p.off[i] -= (ideal_point(problem, s, i) - *s.station).norm();
      p.about_median = true;
      p.limit = kTracer_mm;
    } else if (s.kind == ObservationKind::diagonal || s.kind == ObservationKind::step) {
      p.off[i] -= s.along->dot(ideal_point(problem, s, i));
      p.about_median = true;
    } else if (s.kind == ObservationKind::centre) {
      const Vec3 tip = ideal_point(problem, s, i);
      for (std::size_t k = 0; k < 3; ++k)
        p.off[3 * i + k] -= tip(static_cast<Index>(k));
    }
  }
  return p;
}

Refusal check_units(const Problem& problem, const SetUp& s) {
  constexpr double kRun_mm = 1.0;
  constexpr double kRun_rad = 5e-3;
  if (s.y.empty()) return {};
  const Plausible p = plausible(problem, s);
  const double middle = p.about_median ? median(p.off) : 0.0;
  for (std::size_t n = 0; n < p.off.size(); ++n) {
    double limit = p.limit;
    if (s.kind == ObservationKind::runs)
      limit = s.channels[n % s.components()] < 3 ? kRun_mm : kRun_rad;
    if (std::abs(p.off[n] - middle) > limit)
      return placed(refusal(Reason::unit_suspected, s), n / s.components());
  }
  return {};
}

Refusal check_station(const Problem& problem, const SetUp& s) {
  constexpr double kClear_mm = 20.0;
  if (s.kind != ObservationKind::tracer && s.kind != ObservationKind::bar) return {};
  std::size_t nearest = 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const double away = (ideal_point(problem, s, i) - *s.station).norm();
    if (away < least) {
      least = away;
      nearest = i;
    }
  }
  return least < kClear_mm ? placed(refusal(Reason::station_in_path, s), nearest) : Refusal{};
}

Refusal check_count(const Problem& problem, const SetUp& s) {
  return s.q.size() * s.components() > local_count(problem, s)
             ? Refusal{}
             : refusal(Reason::too_few_observations, s);
}

Refusal check_line(const Problem& problem, const SetUp& s) {
  constexpr double kLine = 1e-6;
  if (!s.has_pose()) return {};
  Vec3 mean = Vec3::Zero();
  for (const std::size_t sphere : s.sphere)
    mean += problem.artefacts[*s.artefact].spheres[sphere] / static_cast<double>(s.sphere.size());
  Mat3 squares = Mat3::Zero();
  for (const std::size_t sphere : s.sphere) {
    const Vec3 c = problem.artefacts[*s.artefact].spheres[sphere] - mean;
    squares += c * c.transpose();
  }
  // The singular values of the places are the roots of these.
  const Vec3 root = Eigen::JacobiSVD<Mat3>(squares).singularValues().cwiseSqrt();
  return root(1) > kLine * root(0) ? Refusal{} : refusal(Reason::collinear, s);
}

Refusal check_motion(const Problem& problem) {
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    if (problem.model.functions.at(a).segments == 0) continue;
    const auto range = problem.range_of(a);
    if (range && range->hi > range->lo) continue;
    Refusal r;
    r.reason = Reason::axis_never_moved;
    r.axis = problem.machine.name_of(a);
    return r;
  }
  return {};
}

Refusal check_rank(const Problem& problem) {
  const PlanRank rank = rank_of(problem);
  const std::size_t gauge = problem.model.gauge.size();
  Refusal r;
  if (!(least_singular(Equations::made_consistent(problem)) > kSingularShare)) {
    r.reason = Reason::not_observable;
    r.nullity_functions = rank.nullity_functions - std::min(rank.nullity_functions, gauge);
    r.names = rank.unseen;
  } else if (rank.nullity_functions < gauge) {
    r.reason = Reason::gauge_excess;
    r.nullity_functions = rank.nullity_functions;
  }
  return r;
}

}  // namespace

Refusal check_problem(const Problem& problem) {
  const auto each = [&](Refusal (*check)(const Problem&, const SetUp&)) {
    return first_of(problem, [&](const SetUp& s) { return check(problem, s); });
  };
  const std::array<std::function<Refusal()>, 15> checks{
      [&] { return check_parts(problem); },
      [&] { return first_of(problem, check_fields); },
      [&] { return check_names(problem); },
      [&] { return each(check_references); },
      [&] { return first_of(problem, check_lengths); },
      [&] { return check_finite(problem); },
      [&] { return first_of(problem, check_sigma); },
      [&] { return check_reference_stylus(problem); },
      [&] { return each(check_travel); },
      [&] { return each(check_units); },
      [&] { return each(check_station); },
      [&] { return each(check_count); },
      [&] { return each(check_line); },
      [&] { return check_motion(problem); },
      [&] { return check_rank(problem); }};
  for (const auto& check : checks)
    if (Refusal r = check(); !r.ok()) return r;
  return {};
}

Refusal check_solution(const Solution& solution) {
  constexpr double kContradiction = 25.0;
  Refusal r;
  if (!solution.converged)
    r.reason = Reason::not_converged;
  else if (solution.dof > 0 && solution.chi2 > kContradiction * static_cast<double>(solution.dof))
    r.reason = Reason::contradictory;
  return r;
}

}  // namespace volcomp::host::identify
