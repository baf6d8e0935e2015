#include "comp/metrology/tables/run_checks.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp {
namespace {

constexpr double kMaxTranslation_mm = 1.0;
constexpr double kMaxRotation_rad = 5e-3;
constexpr double kMaxLever_mm = 5000.0;

struct Channel {
  const char* direction = "";
  Span<const Run> runs;
};

Where at_axis(const MeasuredAxis& m) {
  Where where;
  where.axis = m.letter;
  return where;
}

Status check_fields(const MeasuredAxis& m) {
  Where where = at_axis(m);
  if (!m.convention) where.field = "convention";
  if (!m.sensed_at_zero) where.field = "L0";
  if (!m.kappa) where.field = "kappa";
  return where.field == nullptr ? Status{} : refuse(Reason::missing_field, where);
}

Status check_counts(const MeasuredAxis& m) {
  Where where = at_axis(m);
  where.count = static_cast<int>(m.positions.size());
  if (m.positions.size() < 2) return refuse(Reason::too_few_knots, where);
  if (m.positions.size() > kTableKnots) return refuse(Reason::too_many_knots, where);
  where.count = -1;
  if (m.up.empty() && m.down.empty()) return refuse(Reason::no_runs, where);
  for (const Channel& c : {Channel{"up", m.up}, Channel{"down", m.down}}) {
    where.direction = c.direction;
    if (c.runs.size() > kMaxRuns) return refuse(Reason::too_many_runs, where);
    for (std::size_t r = 0; r < c.runs.size(); ++r) {
      if (c.runs[r].size() == m.positions.size()) continue;
      where.run = static_cast<int>(r);
      where.count = static_cast<int>(c.runs[r].size());
      return refuse(Reason::run_length, where);
    }
  }
  return {};
}

// First value in scan order (up, then down; run, target, channel ascending) that `bad` accepts.
template <class Predicate>
Status find_bad_value(const MeasuredAxis& m, const AscendingRuns& view, Reason reason,
                      Predicate bad) {
  for (const Channel& c : {Channel{"up", m.up}, Channel{"down", m.down}}) {
    for (std::size_t r = 0; r < c.runs.size(); ++r) {
      for (std::size_t t = 0; t < view.targets(); ++t) {
        for (Eigen::Index ch = 0; ch < 6; ++ch) {
          const double value = view.value(c.runs, r, t, ch);
          if (!bad(value, ch)) continue;
          Where where = at_axis(m);
          where.direction = c.direction;
          where.run = static_cast<int>(r);
          where.target = static_cast<int>(t);
          where.channel = static_cast<int>(ch);
          where.value = value;
          where.has_value = true;
          return refuse(reason, where);
        }
      }
    }
  }
  return {};
}

Status check_positions(const MeasuredAxis& m, const AscendingRuns& view) {
  Where where = at_axis(m);
  const double forwards = view.reversed() ? -1.0 : 1.0;
  for (std::size_t i = 1; i < view.targets(); ++i) {
    const double step = forwards * (m.positions[i] - m.positions[i - 1]);
    if (step > 0.0) continue;
    where.target = static_cast<int>(i);
    return refuse(step < 0.0 ? Reason::positions_not_monotone : Reason::positions_duplicate, where);
  }
  if (view.uniform()) return {};
  if (!m.allow_resampling) {
    for (std::size_t i = 0; i < view.targets(); ++i) {
      const double deviation =
          view.position(i) - (view.position(0) + static_cast<double>(i) * view.pitch());
      if (std::abs(deviation) <= m.uniform_tolerance) continue;
      where.target = static_cast<int>(view.original(i));
      where.deviation = deviation;
      where.has_deviation = true;
      return refuse(Reason::positions_not_uniform, where);
    }
  }
  std::array<double, kTableKnots> gap{};
  const std::size_t n = view.targets() - 1;
  for (std::size_t i = 0; i < n; ++i)
    gap[i] = view.position(i + 1) - view.position(i);
  std::array<double, kTableKnots> sorted = gap;
  std::nth_element(sorted.begin(), sorted.begin() + n / 2, sorted.begin() + n);
  for (std::size_t i = 0; i < n; ++i) {
    if (gap[i] <= 2.0 * sorted[n / 2]) continue;
    where.target = static_cast<int>(std::max(view.original(i), view.original(i + 1)));
    where.value = gap[i];
    where.has_value = true;
    return refuse(Reason::gap_too_large, where);
  }
  return {};
}

// Arms in metres show as values below 1 mm; a lever of exactly zero is a statement, not a mistake.
Status check_lever(const MeasuredAxis& m) {
  Where where = at_axis(m);
  where.field = "L0";
  if (!m.sensed_at_zero->allFinite()) return refuse(Reason::not_finite, where);
  const double longest = m.sensed_at_zero->cwiseAbs().maxCoeff();
  where.value = longest;
  where.has_value = true;
  const bool looks_like_metres = longest > 0.0 && longest < 1.0;
  if (longest > kMaxLever_mm || looks_like_metres) return refuse(Reason::unit_suspected, where);
  where.field = "kappa";
  where.value = *m.kappa;
  if (*m.kappa < -1 || *m.kappa > 1) return refuse(Reason::bad_setting, where);
  return {};
}

}  // namespace

double AscendingRuns::pitch() const {
  return (position(targets() - 1) - position(0)) / static_cast<double>(targets() - 1);
}

bool AscendingRuns::uniform() const {
  for (std::size_t i = 0; i < targets(); ++i) {
    const double ideal = position(0) + static_cast<double>(i) * pitch();
    if (std::abs(position(i) - ideal) > measured_.uniform_tolerance) return false;
  }
  return true;
}

bool is_descending(Span<const double> positions) {
  return positions[positions.size() - 1] < positions[0];
}

Status check_runs(const MeasuredAxis& m) {
  if (const Status s = check_fields(m); !s.ok()) return s;
  if (const Status s = check_counts(m); !s.ok()) return s;

  const AscendingRuns as_given(m, false);
  const auto not_finite = [](double value, Eigen::Index) { return !std::isfinite(value); };
  if (const Status s = find_bad_value(m, as_given, Reason::not_finite, not_finite); !s.ok())
    return s;
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    if (std::isfinite(m.positions[i])) continue;
    Where where = at_axis(m);
    where.field = "position";
    where.target = static_cast<int>(i);
    return refuse(Reason::not_finite, where);
  }

  const AscendingRuns view(m, is_descending(m.positions));
  if (const Status s = check_positions(m, view); !s.ok()) return s;
  const auto implausible = [](double value, Eigen::Index channel) {
    return std::abs(value) > (channel < 3 ? kMaxTranslation_mm : kMaxRotation_rad);
  };
  if (const Status s = find_bad_value(m, as_given, Reason::unit_suspected, implausible); !s.ok())
    return s;
  if (const Status s = check_lever(m); !s.ok()) return s;
  if (m.reference >= 0 && static_cast<std::size_t>(m.reference) < view.targets()) return {};
  Where where = at_axis(m);
  where.index = m.reference;
  return refuse(Reason::reference_out_of_range, where);
}

}  // namespace volcomp
