#pragma once
// Campaigns along one axis whose true figures are known: shapes of the error, how runs scatter, and
// what intervals the product finds.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host_sim/host/measure/intervals/positioning_interval.hpp"
#include "tests/bench/coverage_shares.hpp"

namespace volcomp::test {

using namespace host;

inline constexpr double kTravel_mm = 500.0;
inline constexpr std::size_t kFigures = 5;
inline constexpr std::array<const char*, kFigures> kNames{"E", "B", "M", "A", "R"};

struct Size {
  std::size_t targets = 0;
  double sigma_um = 0.0;
};
// The first three have every σ once, and all but the last number of targets, which takes most of
// the time.
inline constexpr std::array<Size, 12> kSizes{{{11, 0.7},
                                              {5, 0.1},
                                              {21, 2.0},
                                              {5, 0.7},
                                              {5, 2.0},
                                              {11, 0.1},
                                              {11, 2.0},
                                              {21, 0.1},
                                              {21, 0.7},
                                              {51, 0.1},
                                              {51, 0.7},
                                              {51, 2.0}}};

// Of the mean, µm, at target i of m.
struct Shape {
  const char* name;
  double (*mean)(std::size_t i, std::size_t m, bool up);
};
inline constexpr std::array<Shape, 4> kShapes{{
    {"nothing left", [](std::size_t, std::size_t, bool) { return 0.0; }},
    {"one extreme",
     [](std::size_t i, std::size_t m, bool up) { return i == 2 * (m - 1) / 5 && up ? 10.0 : 0.0; }},
    {"several equal",
     [](std::size_t i, std::size_t, bool up) { return i % 3 == 0 ? 4.0
                                                      : up       ? 0.0
                                                                 : -2.0; }},
    {"a bow and reversal",
     [](std::size_t i, std::size_t m, bool up) {
       const double t = static_cast<double>(i) / static_cast<double>(m - 1);
       return 12.0 * t * (1.0 - t) + (up ? 1.0 : 0.0);
     }},
}};

// How runs scatter, what is known of them, and what an independent program reached at least over
// other shapes, percent by kNames (measurement.md of the specification, section 4.7).
struct Condition {
  const char* name;
  std::size_t runs;
  bool along;              // 0.5 σ … 1.5 σ along the travel
  bool drift;              // runs share N(0, σ²), and walk on while they last: ½ σ at their end
  double scale_um_per_mm;  // of the instrument, 1 σ, stated
  std::array<double, kFigures> least;
};
inline constexpr std::array<Condition, 7> kConditions{{
    {"equal, n = 5", 5, false, false, 0.0, {94, 94, 94, 93, 93}},
    {"equal, n = 2", 2, false, false, 0.0, {93, 93, 93, 97, 96}},
    {"0.5 s … 1.5 s along the travel, n = 5", 5, true, false, 0.0, {94, 94, 93, 93, 93}},
    {"0.5 s … 1.5 s along the travel, n = 2", 2, true, false, 0.0, {93, 93, 91, 96, 96}},
    {"runs differ by s and walk ½ s, n = 5", 5, false, true, 0.0, {94, 94, 94, 89, 86}},
    {"runs differ by s and walk ½ s, n = 2", 2, false, true, 0.0, {94, 94, 94, 91, 89}},
    {"scale 0.5 µm/m (1 σ), n = 5", 5, false, false, 0.5e-3, {92, 96, 92, 92, 95}},
}};

// The same of the one-sided bound, over all conditions: the least of A and R is that of drift.
inline std::array<double, kFigures> least_of_bound(const Condition& condition) {
  if (condition.drift) return {93.0, 93.5, 91.8, 86.4, 87.5};
  return {93.0, 93.5, 91.8, 91.0, 91.0};
}

// By column: targets up, then the same targets down, µm. A run goes up first, then down again.
struct Truth {
  Size size;
  std::vector<double> mean;
  std::vector<double> own;    // σ of a reading besides what its run shares
  std::vector<double> sigma;  // and with it: of single readings, over many runs

  [[nodiscard]] double position(std::size_t target) const {
    return kTravel_mm * static_cast<double>(target) / static_cast<double>(size.targets - 1);
  }
};

// Of a step between two readings.
inline double walk_step(const Size& size) {
  return 0.5 * size.sigma_um / std::sqrt(2.0 * static_cast<double>(size.targets));
}

inline Truth truth_of(const Shape& shape, const Condition& condition, const Size& size) {
  Truth truth{size, {}, {}, {}};
  const std::size_t m = size.targets;
  for (std::size_t column = 0; column < 2 * m; ++column) {
    const bool up = column < m;
    const std::size_t i = up ? column : column - m;
    const double t = static_cast<double>(i) / static_cast<double>(m - 1);
    const double own = size.sigma_um * (condition.along ? 0.5 + t : 1.0);
    const double steps = static_cast<double>(up ? i : 2 * m - 1 - i);
    const double shared = condition.drift ? size.sigma_um : 0.0;
    const double walked = condition.drift ? walk_step(size) * std::sqrt(steps) : 0.0;
    truth.mean.push_back(shape.mean(i, m, up));
    truth.own.push_back(own);
    truth.sigma.push_back(std::hypot(own, shared, walked));
  }
  return truth;
}

// As the definitions of ISO 230-2 read, with the standard deviation of the population.
inline std::array<double, kFigures> true_figures(const Truth& truth) {
  std::vector<double> both, upper, lower;
  double B = 0.0;
  double R = 0.0;
  const std::size_t m = truth.size.targets;
  for (std::size_t i = 0; i < m; ++i) {
    const double reversal = std::abs(truth.mean[i] - truth.mean[m + i]);
    const double s_up = truth.sigma[i];
    const double s_down = truth.sigma[m + i];
    both.push_back(0.5 * (truth.mean[i] + truth.mean[m + i]));
    B = std::max(B, reversal);
    R = std::max({R, 2.0 * s_up + 2.0 * s_down + reversal, 4.0 * s_up, 4.0 * s_down});
  }
  for (std::size_t column = 0; column < 2 * m; ++column) {
    upper.push_back(truth.mean[column] + 2.0 * truth.sigma[column]);
    lower.push_back(truth.mean[column] - 2.0 * truth.sigma[column]);
  }
  const auto range = [](const std::vector<double>& top, const std::vector<double>& bottom) {
    return *std::max_element(top.begin(), top.end()) -
           *std::min_element(bottom.begin(), bottom.end());
  };
  return {range(truth.mean, truth.mean), B, range(both, both), range(upper, lower), R};
}

inline PositioningIntervals measured(const Truth& truth, const Condition& condition,
                                     const CoverageOptions& options, std::size_t campaign) {
  const Noise noise(options.seed, campaign);
  const std::size_t m = truth.size.targets;
  const double scale = condition.scale_um_per_mm * noise(1000, 0);
  std::vector<double> positions;
  for (std::size_t i = 0; i < m; ++i)
    positions.push_back(truth.position(i));
  std::vector<std::vector<double>> up(condition.runs), down(condition.runs);
  for (std::size_t run = 0; run < condition.runs; ++run) {
    down[run].resize(m);
    double drift = condition.drift ? truth.size.sigma_um * noise(run, 1000) : 0.0;
    for (std::size_t step = 0; step < 2 * m; ++step) {
      const std::size_t i = step < m ? step : 2 * m - 1 - step;
      const std::size_t column = step < m ? i : m + i;
      if (condition.drift && step > 0) drift += walk_step(truth.size) * noise(run, 2000 + step);
      const double reading = truth.mean[column] + drift + scale * positions[i] +
                             truth.own[column] * noise(run, column);
      if (step < m)
        up[run].push_back(reading);
      else
        down[run][i] = reading;
    }
  }
  return *run_intervals(positions, up, down, {condition.scale_um_per_mm, 0.0},
                        options.seed + campaign, options.draws)
              .of;
}

}  // namespace volcomp::test
