#pragma once
// Campaigns along one axis whose true figures are known: shapes of the error, how runs scatter, and
// what intervals the product finds.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/intervals/positioning_interval.hpp"

namespace volcomp::test {

using namespace host;

inline constexpr std::size_t kTargets = 11;
inline constexpr double kTravel_mm = 500.0;
inline constexpr double kSigma_um = 0.7;
inline constexpr std::size_t kFigures = 5;
inline constexpr std::array<const char*, kFigures> kNames{"E", "B", "M", "A", "R"};

struct CoverageOptions {
  std::size_t campaigns = 1000;
  std::size_t draws = 1000;
  std::uint64_t seed = 1;
};

// Of the mean, µm, t = 0…1 along the travel.
struct Shape {
  const char* name;
  double (*mean)(double t, bool up);
};
inline constexpr std::array<Shape, 4> kShapes{{
    {"nothing left", [](double, bool) { return 0.0; }},
    {"one extreme", [](double t, bool up) { return std::abs(t - 0.4) < 0.01 && up ? 10.0 : 0.0; }},
    {"several equal",
     [](double t, bool up) { return std::lround(10.0 * t) % 3 == 0 ? 4.0
                                    : up                           ? 0.0
                                                                   : -2.0; }},
    {"a bow and reversal",
     [](double t, bool up) { return 12.0 * t * (1.0 - t) + (up ? 1.0 : 0.0); }},
}};

// How runs scatter, and what is known of them.
struct Condition {
  const char* name;
  std::size_t runs;
  bool along;                          // 0.5 σ … 1.5 σ along the travel
  double shared;                       // σ that whole runs share
  double scale_um_per_mm;              // of the instrument, 1 σ, stated
  std::array<double, kFigures> least;  // percent, by kNames
};
inline constexpr std::array<Condition, 5> kConditions{{
    {"equal, n = 5", 5, false, 0.0, 0.0, {94, 94, 94, 93, 93}},
    {"equal, n = 2", 2, false, 0.0, 0.0, {93, 93, 93, 97, 96}},
    {"0.5 s … 1.5 s along the travel, n = 5", 5, true, 0.0, 0.0, {94, 94, 93, 93, 93}},
    {"whole runs differ by s, n = 5", 5, false, 1.0, 0.0, {94, 94, 94, 89, 86}},
    {"scale 0.5 µm/m (1 σ), n = 5", 5, false, 0.0, 0.5e-3, {92, 96, 92, 92, 95}},
}};

// The truth of a condition: means by direction, σ of single readings by place.
struct Truth {
  std::vector<double> up, down, sigma;
};

inline Truth truth_of(const Shape& shape, const Condition& condition) {
  Truth truth;
  for (std::size_t i = 0; i < kTargets; ++i) {
    const double t = static_cast<double>(i) / (kTargets - 1);
    truth.up.push_back(shape.mean(t, true));
    truth.down.push_back(shape.mean(t, false));
    truth.sigma.push_back(kSigma_um * (condition.along ? 0.5 + t : 1.0));
  }
  return truth;
}

// As the definitions of ISO 230-2 read, with the standard deviation of the population.
inline std::array<double, kFigures> true_figures(const Truth& truth, const Condition& condition) {
  std::vector<double> ends, both, upper, lower;
  double B = 0.0;
  double R = 0.0;
  for (std::size_t i = 0; i < kTargets; ++i) {
    const double s = truth.sigma[i] * std::hypot(1.0, condition.shared);
    const double reversal = truth.up[i] - truth.down[i];
    for (const double mean : {truth.up[i], truth.down[i]}) {
      ends.push_back(mean);
      upper.push_back(mean + 2.0 * s);
      lower.push_back(mean - 2.0 * s);
    }
    both.push_back(0.5 * (truth.up[i] + truth.down[i]));
    B = std::max(B, std::abs(reversal));
    R = std::max({R, 4.0 * s + std::abs(reversal)});
  }
  const auto range = [](const std::vector<double>& top, const std::vector<double>& bottom) {
    return *std::max_element(top.begin(), top.end()) -
           *std::min_element(bottom.begin(), bottom.end());
  };
  return {range(ends, ends), B, range(both, both), range(upper, lower), R};
}

inline bool holds(const FigureInterval& interval, double truth) {
  constexpr double kRounding = 1e-9;
  return interval.low <= truth + kRounding && truth <= interval.high + kRounding;
}

// Noise of a campaign: readings are counted, so that no order of computing matters.
class Noise {
 public:
  Noise(std::uint64_t seed, std::size_t campaign)
      : seed_(seed + (std::uint64_t{1} << 40U)), campaign_(static_cast<std::uint32_t>(campaign)) {}

  double operator()(std::size_t set_up, std::size_t reading) const {
    constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::repeatability);
    return normal(seed_, {kStream, campaign_, static_cast<std::uint32_t>(set_up),
                          static_cast<std::uint32_t>(reading)});
  }

 private:
  std::uint64_t seed_;
  std::uint32_t campaign_;
};

inline PositioningIntervals measured(const Truth& truth, const Condition& condition,
                                     const CoverageOptions& options, std::size_t campaign) {
  const Noise noise(options.seed, campaign);
  const double scale = condition.scale_um_per_mm * noise(1000, 0);
  std::vector<double> positions;
  for (std::size_t i = 0; i < kTargets; ++i)
    positions.push_back(kTravel_mm * static_cast<double>(i) / (kTargets - 1));
  std::vector<std::vector<double>> up(condition.runs), down(condition.runs);
  for (std::size_t run = 0; run < condition.runs; ++run) {
    const double shared = condition.shared * kSigma_um * noise(run, 1000);
    for (std::size_t i = 0; i < kTargets; ++i) {
      const double common = shared + scale * positions[i];
      up[run].push_back(truth.up[i] + common + truth.sigma[i] * noise(run, i));
      down[run].push_back(truth.down[i] + common + truth.sigma[i] * noise(run, kTargets + i));
    }
  }
  return *run_intervals(positions, up, down, {condition.scale_um_per_mm, 0.0},
                        options.seed + campaign, options.draws)
              .of;
}

}  // namespace volcomp::test
