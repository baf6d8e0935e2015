#include "comp/metrology/gears/gear_tolerance.hpp"

#include <cmath>

#include "comp/core/span.hpp"

namespace volcomp {
namespace {

using Values = std::array<double, kGearDeviations>;

// Rows of the tables of 1995: the ends of the ranges, mm.
constexpr std::array<double, 12> kDiameters{5,    20,   50,   125,  280,  560,
                                            1000, 1600, 2500, 4000, 6000, 8000};
constexpr double kLastDiameter = 10000;
constexpr std::array<double, 8> kModules{0.5, 2, 3.5, 6, 10, 16, 25, 40};
constexpr double kLastModule = 70;
constexpr std::array<double, 8> kWidths{4, 10, 20, 40, 80, 160, 250, 400};
constexpr std::array<double, 2> kLastWidths{650, 1000};

struct Range {
  const char* field;
  double low;
  double high;
};

// The row of `value`: lower end exclusive but in the first row, upper inclusive.
template <std::size_t N>
GearRow::Range row_of(const std::array<double, N>& ends, double value) {
  std::size_t row = 0;
  while (row + 2 < N && value > ends[row + 1])
    ++row;
  return {ends[row], ends[row + 1]};
}

template <std::size_t N>
double row_mean(const std::array<double, N>& ends, double value) {
  const GearRow::Range row = row_of(ends, value);
  return std::sqrt(row.over * row.to);  // geometric
}

template <std::size_t N, std::size_t M>
constexpr std::array<double, N + M> joined(const std::array<double, N>& a,
                                           const std::array<double, M>& b) {
  std::array<double, N + M> all{};
  for (std::size_t i = 0; i < N; ++i)
    all[i] = a[i];
  for (std::size_t i = 0; i < M; ++i)
    all[N + i] = b[i];
  return all;
}

constexpr auto kDiameterRows = joined(kDiameters, std::array<double, 1>{kLastDiameter});
constexpr auto kModuleRows = joined(kModules, std::array<double, 1>{kLastModule});
constexpr auto kWidthRows = joined(kWidths, kLastWidths);

// Class 5 of 1995, from row means.
Values class_five_1995(const GearSize& size) {
  const double d = row_mean(kDiameterRows, size.diameter);
  const double m = row_mean(kModuleRows, size.module);
  const double b = row_mean(kWidthRows, size.width);
  const double sqrt_d = std::sqrt(d);
  const double sqrt_m = std::sqrt(m);
  const double sqrt_b = std::sqrt(b);
  const double total_pitch = 0.3 * m + 1.25 * sqrt_d + 7.0;
  const double lead_part = 0.07 * sqrt_d + 0.45 * sqrt_b + 3.0;
  return {0.3 * (m + 0.4 * sqrt_d) + 4.0,
          total_pitch,
          3.2 * sqrt_m + 0.22 * sqrt_d + 0.7,
          2.5 * sqrt_m + 0.17 * sqrt_d + 0.5,
          2.0 * sqrt_m + 0.14 * sqrt_d + 0.5,
          0.1 * sqrt_d + 0.63 * sqrt_b + 4.2,
          lead_part,
          lead_part,
          0.8 * total_pitch};
}

// Class 5 of 2013, from the sizes themselves; totals from unrounded components.
Values class_five_2013(const GearSize& size) {
  const double d = size.diameter;
  const double m = size.module;
  const double sqrt_d = std::sqrt(d);
  const double sqrt_b = std::sqrt(size.width);
  const double total_pitch = 0.002 * d + 0.55 * sqrt_d + 0.7 * m + 12.0;
  const double profile_form = 0.55 * m + 5.0;
  const double profile_slope = 0.4 * m + 0.001 * d + 4.0;
  const double lead_form = 0.07 * sqrt_d + 0.45 * sqrt_b + 4.0;
  const double lead_slope = 0.05 * sqrt_d + 0.35 * sqrt_b + 4.0;
  return {0.001 * d + 0.4 * m + 5.0,
          total_pitch,
          std::hypot(profile_slope, profile_form),
          profile_form,
          profile_slope,
          std::hypot(lead_slope, lead_form),
          lead_form,
          lead_slope,
          0.9 * total_pitch};
}

// To 1 µm above 10, to 0.5 from 5 to 10, to 0.1 below; half upwards.
double rounded(double um) {
  const double step = um > 10.0 ? 1.0 : um >= 5.0 ? 0.5 : 0.1;
  return step * std::floor(um / step + 0.5 + 1e-12);
}

}  // namespace

GearRow gear_row(const GearSize& size) {
  return {row_of(kDiameterRows, size.diameter), row_of(kModuleRows, size.module),
          row_of(kWidthRows, size.width)};
}

int first_grade(GearStandard standard) { return standard == GearStandard::iso1328_1995 ? 0 : 1; }

int last_grade(GearStandard standard) { return standard == GearStandard::iso1328_1995 ? 12 : 11; }

Status check_size(GearStandard standard, const GearSize& size) {
  const bool old = standard == GearStandard::iso1328_1995;
  const auto inside = [](const Range& range, double value, Status& status) {
    if (value >= range.low && value <= range.high) return true;
    Where where;
    where.field = range.field;
    where.value = value;
    where.has_value = true;
    status = refuse(Reason::out_of_standard, where);
    return false;
  };
  Status status;
  if (!inside({"diameter", 5.0, old ? kLastDiameter : 15000.0}, size.diameter, status))
    return status;
  if (!inside({"module", 0.5, kLastModule}, size.module, status)) return status;
  if (!inside({"width", 4.0, old ? 1000.0 : 1200.0}, size.width, status)) return status;
  return {};
}

GearLimits gear_limits(GearStandard standard, const GearSize& size, int grade) {
  const bool old = standard == GearStandard::iso1328_1995;
  const Values five = old ? class_five_1995(size) : class_five_2013(size);
  const double scale = std::exp2(0.5 * (grade - 5));
  GearLimits limits;
  for (std::size_t i = 0; i < kGearDeviations; ++i) {
    limits.exact[i] = five[i] * scale;
    limits.rounded[i] = rounded(limits.exact[i]);
  }
  return limits;
}

std::optional<int> grade_of(GearStandard standard, const GearSize& size, GearDeviation deviation,
                            double value_um) {
  constexpr double kTie = 1e-9;
  for (int grade = first_grade(standard); grade <= last_grade(standard); ++grade) {
    const GearLimits limits = gear_limits(standard, size, grade);
    if (std::abs(value_um) <= limits.rounded[static_cast<std::size_t>(deviation)] + kTie)
      return grade;
  }
  return std::nullopt;
}

}  // namespace volcomp
