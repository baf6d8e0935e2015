#pragma once
// What a machine can be: the largest numbers of a machine description. Beyond them a number is
// damaged or has the wrong unit. The readers of machine files and the checks of images take the
// same. Within them nothing that staging or the tick adds up leaves the range of a float: 16
// offsets of 5 m are 1e11 nm. Table values are bounded by what they add up to (kMaxBound_nm).

#include <cstddef>

#include "comp/core/status.hpp"

namespace volcomp {

// Component of a joint offset or a tool point, mm: arms and stands of machines are below 5 m.
inline constexpr double kMaxOffset_mm = 5000.0;
// Squareness of one pair of axes, rad: beyond it an angle was given in arc seconds.
inline constexpr double kMaxSquareness_rad = 5e-3;
// Component of the direction of an axis, rad: the pairs with both other axes.
inline constexpr double kMaxDirection_rad = 2.0 * kMaxSquareness_rad;
// Constant error of a body in a machine file or an image, mm and rad. The exact model computes with
// any.
inline constexpr double kMaxConstantError_mm = 1.0;
inline constexpr double kMaxConstantError_rad = 5e-3;

// ok, or not_finite or bound_exceeded for the first of `count` numbers that is not within ±most.
[[nodiscard]] Reason check_numbers(const double* number, std::size_t count, double most);

}  // namespace volcomp
