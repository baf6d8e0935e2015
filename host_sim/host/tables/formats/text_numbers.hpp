#pragma once
// Numbers as controller tables write them: fixed, six decimals, "." whatever the locale, no "-0".

#include <string>
#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

[[nodiscard]] std::string six_decimals(double value);

// Nearest integer, half away from zero; of numbers that kInt32 holds.
[[nodiscard]] long long nearest(double value);

// What a number of a file can be.
struct NumberForm {
  double last_digits = 1.0;  // in one unit of the file
  double most = 0.0;         // units of the file
};
inline constexpr NumberForm kSixDecimals{1e6, 1e9};  // beyond, a double has fewer decimals
inline constexpr NumberForm kInt32{1.0, 2147483647.0};

// Checks a table before it is written: at least two offsets, at most `capacity`, all finite and of
// the form, the first and the last printed alike if it is to wrap; `file_units`: in one mm or rad.
// Refuses too_few_knots, too_many_knots (count), not_finite (index), bad_setting ("offset", index),
// not_periodic (deviation).
Status check_offsets(const std::vector<double>& offsets, std::size_t capacity, bool modulo,
                     const NumberForm& form, double file_units);

// Whether six decimals hold both ends of a table of `entries` positions.
[[nodiscard]] bool fits_extent(double min, double step, std::size_t entries);

// Positions that ascend as they are printed, as many as offsets; `file_units`: in one mm or degree.
// length_mismatch, not_finite, bad_setting ("position"), positions_duplicate,
// positions_not_monotone (index).
Status check_nominal(const std::vector<double>& nominal, std::size_t offsets,
                     const NumberForm& form, double file_units = 1.0);

}  // namespace volcomp::host
