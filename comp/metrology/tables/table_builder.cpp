#include "comp/metrology/tables/table_builder.hpp"

#include <algorithm>
#include <cmath>

#include "comp/metrology/tables/line_fit.hpp"
#include "comp/metrology/tables/run_checks.hpp"

namespace volcomp {
namespace {

constexpr double kOutlierFactor =
    5.0 * 1.4826;                        // MAD → standard deviation of a normal distribution
constexpr double kOutlierFloor = 0.010;  // 10 µm; angles: 10 µrad, a thousandth of it in rad
constexpr double kSteepSlope = 200e-6;

double outlier_floor(Eigen::Index channel) {
  return channel < 3 ? kOutlierFloor : 1e-3 * kOutlierFloor;
}

// Mean and standard deviation of every channel over the runs of one direction.
void average(const AscendingRuns& view, Span<const Run> runs, TableColumn& mean,
             TableColumn& deviation) {
  const auto n = static_cast<double>(runs.size());
  for (std::size_t t = 0; t < view.targets(); ++t) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      double sum = 0.0;
      for (std::size_t r = 0; r < runs.size(); ++r)
        sum += view.value(runs, r, t, c);
      const double m = sum / n;
      double squares = 0.0;
      for (std::size_t r = 0; r < runs.size(); ++r) {
        const double d = view.value(runs, r, t, c) - m;
        squares += d * d;
      }
      mean[t](c) = m;
      deviation[t](c) = runs.size() > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
    }
  }
}

// Reorders the values. nth_element rather than sort: no recursion.
double median(Span<double> values) {
  double* const middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

void note_outlier(BuiltTable& out, const Outlier& outlier) {
  if (out.outlier_count < kMaxOutliers) out.outlier[out.outlier_count] = outlier;
  ++out.outlier_count;
}

// Readings far from the median of their target. They stay in the mean: dropping them is the user's
// decision.
void find_outliers(const AscendingRuns& view, Span<const Run> runs, const char* direction,
                   BuiltTable& out) {
  const std::size_t n = runs.size();
  if (n < 4) return;
  std::array<double, kMaxRuns> work{};
  for (std::size_t t = 0; t < view.targets(); ++t) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      for (std::size_t r = 0; r < n; ++r)
        work[r] = view.value(runs, r, t, c);
      const double centre = median({work.data(), n});
      for (std::size_t r = 0; r < n; ++r)
        work[r] = std::abs(view.value(runs, r, t, c) - centre);
      const double limit = std::max(kOutlierFactor * median({work.data(), n}), outlier_floor(c));
      for (std::size_t r = 0; r < n; ++r) {
        const double value = view.value(runs, r, t, c);
        if (std::abs(value - centre) <= limit) continue;
        note_outlier(out, {direction, static_cast<int>(r), static_cast<int>(t), static_cast<int>(c),
                           value, centre});
      }
    }
  }
}

void warn(BuiltTable& out, Warning warning) {
  if (!out.has(warning)) out.warning[out.warning_count++] = warning;
}

// Both directions shifted so that their mean vanishes at the reference target.
void zero_at(ErrorTable& table, std::size_t count, std::size_t reference) {
  const ErrorMotion zero = table.at_knot(reference, Travel::unknown);
  for (std::size_t t = 0; t < count; ++t) {
    table.forward[t] -= zero;
    table.backward[t] -= zero;
  }
}

double fitted_slope(const MeasuredAxis& m, const BuiltTable& b, Eigen::Index channel) {
  const std::size_t last = b.targets - 1;
  const auto mean = [&](std::size_t t) { return b.table.at_knot(t, Travel::unknown)(channel); };
  if (m.slope == SlopeFit::end_points)
    return (mean(last) - mean(0)) / (b.positions[last] - b.positions[0]);
  std::array<double, kTableKnots> means{};
  for (std::size_t t = 0; t < b.targets; ++t)
    means[t] = mean(t);
  return least_squares_slope({b.positions.data(), b.targets}, {means.data(), b.targets});
}

// A straightness slope is squareness or beam alignment, never straightness: it is taken out here,
// and squareness comes back once, from the closure.
void remove_straightness_slopes(const MeasuredAxis& m, std::size_t reference, BuiltTable& b) {
  b.removed_slope = {};
  if (m.kind != JointKind::prismatic || m.slope == SlopeFit::keep) return;
  for (Eigen::Index c = 0; c < 3; ++c) {
    if (c == static_cast<Eigen::Index>(m.axis)) continue;
    const double slope = fitted_slope(m, b, c);
    b.removed_slope[static_cast<std::size_t>(c)] = slope;
    if (std::abs(slope) > kSteepSlope) warn(b, Warning::steep_slope);
    for (std::size_t t = 0; t < b.targets; ++t) {
      const double line = slope * (b.positions[t] - b.positions[reference]);
      b.table.forward[t](c) -= line;
      b.table.backward[t](c) -= line;
    }
  }
}

void transfer_to_head(const MeasuredAxis& m, BuiltTable& b) {
  const SensedPoint point{*m.sensed_at_zero, *m.kappa};
  const bool travels = m.kind == JointKind::prismatic;
  for (std::size_t t = 0; t < b.targets; ++t) {
    const Vec3 lever = travels ? point.lever(m.axis, b.positions[t]) : point.at_zero;
    b.table.forward[t] = at_head(b.table.forward[t], lever);
    b.table.backward[t] = at_head(b.table.backward[t], lever);
  }
}

void positioning_figures(const MeasuredAxis& m, BuiltTable& b) {
  const auto channel = static_cast<Eigen::Index>(m.axis) + (m.kind == JointKind::rotary ? 3 : 0);
  std::array<double, kTableKnots> up{};
  std::array<double, kTableKnots> down{};
  std::array<double, kTableKnots> su{};
  std::array<double, kTableKnots> sd{};
  for (std::size_t t = 0; t < b.targets; ++t) {
    up[t] = b.table.forward[t](channel);
    down[t] = b.table.backward[t](channel);
    su[t] = b.s_up[t](channel);
    sd[t] = b.s_down[t](channel);
  }
  const std::size_t n = b.targets;
  const Status status = iso230_figures({{up.data(), n}, {su.data(), n}},
                                       {{down.data(), n}, {sd.data(), n}}, b.positioning);
  static_cast<void>(
      status);  // cannot fail: both directions have the same, checked number of targets
}

void average_directions(const MeasuredAxis& m, const AscendingRuns& view, BuiltTable& b) {
  const Span<const Run> up = m.up.empty() ? m.down : m.up;
  const Span<const Run> down = m.down.empty() ? m.up : m.down;
  average(view, up, b.table.forward, b.s_up);
  average(view, down, b.table.backward, b.s_down);
  b.reversal_known = !m.up.empty() && !m.down.empty();
  if (!b.reversal_known) warn(b, Warning::one_direction);
  if (b.reversal_known && m.up.size() != m.down.size()) warn(b, Warning::run_count_differs);
  find_outliers(view, m.up, "up", b);
  find_outliers(view, m.down, "down", b);
  if (b.outlier_count > 0) warn(b, Warning::outlier);
  for (std::size_t t = 0; t < b.targets; ++t)
    b.reversal[t] = b.table.forward[t] - b.table.backward[t];
}

// The knots of the table: the targets themselves where they are uniform, else PCHIP onto a uniform
// grid.
void place_knots(const AscendingRuns& view, BuiltTable& b) {
  b.table.q0 = b.positions[0];
  b.table.pitch = view.pitch();
  b.table.knots = b.targets;
  if (!view.uniform()) {
    const Span<const double> positions{b.positions.data(), b.targets};
    resample_column(Interpolation::pchip, positions, b.table.forward, b.table, b.table.forward);
    resample_column(Interpolation::pchip, positions, b.table.backward, b.table, b.table.backward);
  }
  for (std::size_t t = 1; t < b.targets; ++t) {
    const ErrorMotion jump =
        b.table.at_knot(t, Travel::unknown) - b.table.at_knot(t - 1, Travel::unknown);
    const bool steep = translation(jump).cwiseAbs().maxCoeff() > kJump_mm ||
                       rotation(jump).cwiseAbs().maxCoeff() > kJump_rad;
    if (steep) warn(b, Warning::knot_jump);
  }
}

}  // namespace

const char* code(Warning warning) {
  switch (warning) {
    case Warning::positions_reversed:
      return "positions_reversed";
    case Warning::one_direction:
      return "one_direction";
    case Warning::run_count_differs:
      return "run_count_differs";
    case Warning::outlier:
      return "outlier";
    case Warning::steep_slope:
      return "steep_slope";
    case Warning::knot_jump:
      return "knot_jump";
  }
  return "";
}

bool BuiltTable::has(Warning w) const {
  return std::find(warning.begin(), warning.begin() + warning_count, w) !=
         warning.begin() + warning_count;
}

Status build_table(const MeasuredAxis& measured, BuiltTable& out) {
  if (const Status s = check_runs(measured); !s.ok()) return s;

  const AscendingRuns view(measured, is_descending(measured.positions));
  const std::size_t reference = view.reference();
  out.warning_count = 0;
  out.outlier_count = 0;
  out.convention = *measured.convention;
  out.targets = view.targets();
  for (std::size_t t = 0; t < out.targets; ++t)
    out.positions[t] = view.position(t);
  if (view.reversed()) warn(out, Warning::positions_reversed);

  average_directions(measured, view, out);
  positioning_figures(measured, out);
  zero_at(out.table, out.targets, reference);
  remove_straightness_slopes(measured, reference, out);
  transfer_to_head(measured, out);
  zero_at(out.table, out.targets, reference);
  place_knots(view, out);
  return {};
}

}  // namespace volcomp
