#pragma once
// How often what is known of a whole campaign covers its truth: the radius of a probe from a
// mandrel, the error of a machine at a point from runs.

#include "tests/bench/coverage_shares.hpp"

namespace volcomp::test {

// Each prints rows of a table: interval, upper bound. False where a share is not enough.
bool mandrels_hold(const CoverageOptions& options);
bool whole_ways_hold(const CoverageOptions& options);

}  // namespace volcomp::test
