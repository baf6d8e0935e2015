#pragma once
// Numbers as controller tables write them: fixed, six decimals, "." whatever the locale, no "-0".

#include <string>
#include <vector>

#include "comp/status.hpp"

namespace volcomp::sim {

[[nodiscard]] std::string six_decimals(double value);

// Nearest integer, half away from zero.
[[nodiscard]] long long nearest(double value);

// Throw UserError naming the line unless all of `text` is one number.
[[nodiscard]] double read_decimal(const std::string& text, int line);
[[nodiscard]] long long read_integer(const std::string& text, int line);

// What a complaint quotes of a file that may hold anything: 40 printable characters at most.
[[nodiscard]] std::string printable(const std::string& text);

// The line in front of a complaint about it.
[[nodiscard]] std::string at_line(int line, const std::string& complaint);

// Of a table before it is written: at least two offsets, at most `capacity`, all finite, the first
// and the last printed alike if it is to wrap. too_few_knots, too_many_knots (count), not_finite
// (index), not_periodic (deviation).
Status check_offsets(const std::vector<double>& offsets, std::size_t capacity, bool modulo,
                     double file_units);

// Ascending positions, as many as offsets: length_mismatch, not_finite, positions_duplicate,
// positions_not_monotone (index).
Status check_nominal(const std::vector<double>& nominal, std::size_t offsets);

}  // namespace volcomp::sim
