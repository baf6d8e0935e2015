#pragma once
// What a plan can see, without data: which errors no reading shows, and which are seen together
// only.

#include <string>
#include <vector>

#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

// A singular value below this share of the largest is none.
inline constexpr double kSingularShare = 1e-8;

struct PlanRank {
  std::size_t unknowns = 0;
  std::size_t rank = 0;
  std::size_t nullity = 0;
  // Of that: combinations of error functions, reversals, locations and constants. The rest is
  // harmless: nuisances against each other.
  std::size_t nullity_functions = 0;
  std::vector<std::string> unseen;                 // names, sorted
  std::vector<std::vector<std::string>> together;  // sorted; single names, too
  double least = 0.0;                              // singular value over the largest one
};

// Without gauge rows and without what is known of styli and stations, on consistent ideal geometry:
// a misfit of 30 µm would lift the gauge and hide it.
[[nodiscard]] PlanRank rank_of(const Problem& problem);

// Least singular value over the largest, with gauge and everything known.
[[nodiscard]] double least_singular(const Problem& problem);

}  // namespace volcomp::host::identify
