#pragma once
// Six-channel error table of one axis in double: uniform knots, one column of values per travel
// direction.

#include <array>

#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"
#include "comp/metrology/tables/interpolation.hpp"
#include "comp/tables/machine_tables.hpp"

namespace volcomp {

using TableColumn = std::array<ErrorMotion, kTableKnots>;

enum class Travel : std::uint8_t { unknown, forward, backward };

struct ErrorTable {
  double q0 = 0.0;     // first knot, mm or rad
  double pitch = 0.0;  // > 0
  std::size_t knots = 0;
  TableColumn forward{};  // increasing q
  TableColumn backward{};

  [[nodiscard]] double knot(std::size_t i) const { return q0 + static_cast<double>(i) * pitch; }
  [[nodiscard]] double last() const { return knot(knots - 1); }
  [[nodiscard]] double clamp(double q) const { return q < q0 ? q0 : (q > last() ? last() : q); }

  // Channel values at knot i for a direction; the mean of both when it is unknown.
  [[nodiscard]] ErrorMotion at_knot(std::size_t i, Travel travel) const;

  // Linear interpolation, end values held: what the tick does, in double.
  [[nodiscard]] ErrorMotion linear(double q, Travel travel) const;
};

// Refuses too_few_knots, too_many_knots (> capacity), pitch_not_positive (zero, negative, subnormal
// or not finite), not_finite (where.index = knot, where.channel).
Status check_table(const ErrorTable& table, char axis, std::size_t capacity);

// The same curve on `knots` uniform knots over the same travel.
Status resample(const ErrorTable& table, Interpolation kind, std::size_t knots, ErrorTable& out);

// Each segment divided into `factor`: resample with (knots − 1)·factor + 1 knots.
Status refine(const ErrorTable& table, Interpolation kind, std::size_t factor, ErrorTable& out);

// Interpolates all channels of one column given at arbitrary increasing positions onto uniform
// knots.
void resample_column(Interpolation kind, Span<const double> positions, const TableColumn& values,
                     const ErrorTable& grid, TableColumn& out);

}  // namespace volcomp
