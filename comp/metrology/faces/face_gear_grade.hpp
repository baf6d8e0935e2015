#pragma once
// Grades of a face gear by the deviation of its profile (docs/papers/face-gear.md, "What stays
// open").
//
// Two limits are all the paper quotes, with GB 11365-1989 as their source; the standard was not at
// hand, so neither they nor the definition of the deviation are checked.

#include <array>
#include <cmath>
#include <optional>

namespace volcomp {

struct GradeLimit {
  int grade = 0;
  double limit_um = 0.0;
};
inline constexpr std::array<GradeLimit, 2> kFaceGearLimits{{{4, 4.0}, {5, 6.0}}};
inline constexpr const char* kFaceGearLimitsSource =
    "limits 4 um (grade 4) and 6 um (grade 5) as quoted by the paper from GB 11365-1989, unchecked";

// The smallest of these grades whose limit is not exceeded; none: worse than the last of them, no
// further limit is known.
[[nodiscard]] inline std::optional<int> face_gear_grade(double profile_um) {
  constexpr double kTie = 1e-9;
  for (const GradeLimit& limit : kFaceGearLimits) {
    if (std::abs(profile_um) <= limit.limit_um + kTie) return limit.grade;
  }
  return std::nullopt;
}

}  // namespace volcomp
