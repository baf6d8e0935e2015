#include "comp/metrology/tables/error_table.hpp"

#include <cmath>

namespace volcomp {

ErrorMotion ErrorTable::at_knot(std::size_t i, Travel travel) const {
  switch (travel) {
    case Travel::forward:
      return forward[i];
    case Travel::backward:
      return backward[i];
    case Travel::unknown:
      break;
  }
  return 0.5 * (forward[i] + backward[i]);
}

ErrorMotion ErrorTable::linear(double q, Travel travel) const {
  const double position = (clamp(q) - q0) / pitch;
  auto i = static_cast<std::size_t>(position);
  if (i > knots - 2) i = knots - 2;
  const double t = position - static_cast<double>(i);
  const ErrorMotion a = at_knot(i, travel);
  return a + t * (at_knot(i + 1, travel) - a);
}

Status check_table(const ErrorTable& table, char axis, std::size_t capacity) {
  Where where;
  where.axis = axis;
  where.count = static_cast<int>(table.knots);
  if (table.knots < 2) return refuse(Reason::too_few_knots, where);
  if (table.knots > capacity || table.knots > kTableKnots)
    return refuse(Reason::too_many_knots, where);
  where.count = -1;
  where.value = table.pitch;
  where.has_value = true;
  if (!std::isnormal(table.pitch) || table.pitch <= 0.0)
    return refuse(Reason::pitch_not_positive, where);
  where.value = table.q0;
  if (!std::isfinite(table.q0)) return refuse(Reason::not_finite, where);
  for (std::size_t i = 0; i < table.knots; ++i) {
    for (Eigen::Index c = 0; c < 6; ++c) {
      const double sum = table.forward[i](c) + table.backward[i](c);
      if (std::isfinite(sum)) continue;
      where.value = sum;
      where.index = static_cast<int>(i);
      where.channel = static_cast<int>(c);
      return refuse(Reason::not_finite, where);
    }
  }
  return {};
}

void resample_column(Interpolation kind, Span<const double> positions, const TableColumn& values,
                     const ErrorTable& grid, TableColumn& out) {
  std::array<double, kTableKnots> y{};
  std::array<double, kTableKnots> slope{};
  const std::size_t n = positions.size();
  for (Eigen::Index c = 0; c < 6; ++c) {
    for (std::size_t i = 0; i < n; ++i)
      y[i] = values[i](c);
    const Span<const double> knots{y.data(), n};
    knot_slopes(kind, positions, knots, {slope.data(), n});
    for (std::size_t i = 0; i < grid.knots; ++i) {
      out[i](c) = interpolate(kind, Ends::hold, positions, knots, {slope.data(), n}, grid.knot(i));
    }
  }
}

Status resample(const ErrorTable& table, Interpolation kind, std::size_t knots, ErrorTable& out) {
  if (const Status s = check_table(table, '\0', kTableKnots); !s.ok()) return s;
  Where where;
  where.count = static_cast<int>(knots);
  if (knots < 2) return refuse(Reason::too_few_knots, where);
  if (knots > kTableKnots) return refuse(Reason::too_many_knots, where);
  std::array<double, kTableKnots> positions{};
  for (std::size_t i = 0; i < table.knots; ++i)
    positions[i] = table.knot(i);
  const double travel = table.last() - table.q0;
  out.q0 = table.q0;
  out.pitch = travel / static_cast<double>(knots - 1);
  out.knots = knots;
  resample_column(kind, {positions.data(), table.knots}, table.forward, out, out.forward);
  resample_column(kind, {positions.data(), table.knots}, table.backward, out, out.backward);
  return {};
}

Status refine(const ErrorTable& table, Interpolation kind, std::size_t factor, ErrorTable& out) {
  if (table.knots < 2) return refuse(Reason::too_few_knots);
  return resample(table, kind, (table.knots - 1) * factor + 1, out);
}

}  // namespace volcomp
