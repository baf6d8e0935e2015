// How often the intervals of verification hold the truth: simulated campaigns whose true figures
// are known, for the figures of ISO 230-2, of a circle gone round twice and of a volume.
//
//   volcomp_interval_coverage [--campaigns 1000] [--draws 1000] [--seed 1]
//
// Prints a row for each condition of measurement: least … most over the shapes, percent. Ends with
// 1 where a share is lower than the least of an independent implementation over other shapes, by
// more than 3.5 standard deviations of the sampling. What lies below 95 % there is known and said
// in the report of a measurement: A and R where whole runs differ.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/circles/circle_figures.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/measure/intervals/circle_interval.hpp"
#include "host_sim/host/measure/intervals/volume_interval.hpp"
#include "tests/bench/positioning_campaigns.hpp"

namespace volcomp::test {
namespace {

// Campaigns of `count` whose interval holds the truth, by figure.
using Counts = std::array<std::size_t, kFigures>;

template <class One>
Counts count_held(std::size_t campaigns, const One& one) {
  std::vector<std::array<bool, kFigures>> held(campaigns);
  host::in_parallel(campaigns, host::processors(), [&](std::size_t k) { held[k] = one(k); });
  Counts counts{};
  for (const auto& of : held)
    for (std::size_t f = 0; f < kFigures; ++f)
      counts.at(f) += of.at(f) ? 1U : 0U;
  return counts;
}

// The least share that chance may show of a true one.
bool enough(std::size_t held, std::size_t campaigns, double least_percent) {
  const double n = static_cast<double>(campaigns);
  const double p = least_percent / 100.0;
  return static_cast<double>(held) / n >= p - 3.5 * std::sqrt(p * (1.0 - p) / n);
}

struct Row {
  std::array<double, kFigures> least{};
  std::array<double, kFigures> most{};
  bool good = true;
};

Row positioning_row(const Condition& condition, const CoverageOptions& options) {
  Row row;
  row.least.fill(100.0);
  for (const Shape& shape : kShapes) {
    const Truth truth = truth_of(shape, condition);
    const auto wanted = true_figures(truth, condition);
    const Counts held = count_held(options.campaigns, [&](std::size_t k) {
      const PositioningIntervals found = measured(truth, condition, options, k);
      return std::array<bool, kFigures>{holds(found.E, wanted[0]), holds(found.B, wanted[1]),
                                        holds(found.M, wanted[2]), holds(found.A, wanted[3]),
                                        holds(found.R, wanted[4])};
    });
    for (std::size_t f = 0; f < kFigures; ++f) {
      const double percent =
          100.0 * static_cast<double>(held.at(f)) / static_cast<double>(options.campaigns);
      row.least.at(f) = std::min(row.least.at(f), percent);
      row.most.at(f) = std::max(row.most.at(f), percent);
      if (enough(held.at(f), options.campaigns, condition.least.at(f))) continue;
      row.good = false;
      fmt::print(stderr, "{}, {}: {} holds the truth in {:.1f} %\n", condition.name, shape.name,
                 kNames.at(f), percent);
    }
  }
  return row;
}

// Circles of 72 places gone round twice each way, σ 0.3 µm: nothing left, squareness, backlash.
double circle_deviation_um(std::size_t shape, double theta, double sense) {
  if (shape == 1) return 2.0 * std::sin(2.0 * theta);
  if (shape == 2) return sense * std::copysign(0.5, std::sin(theta)) * std::cos(theta);
  return 0.0;
}

bool circle_holds(std::size_t shape, const CoverageOptions& options, std::size_t campaign) {
  constexpr std::size_t kPlaces = 72;
  constexpr std::size_t kRuns = 2;
  constexpr double kScatter_um = 0.3;
  const Noise noise(options.seed, campaign);
  CircleRuns runs;
  runs.radius = 100.0;
  CircleTest exact;
  exact.radius = runs.radius;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double theta = 2.0 * kPi * static_cast<double>(i) / kPlaces;
    runs.theta.push_back(theta);
  }
  std::vector<double> ccw, cw;
  for (const double theta : runs.theta) {
    ccw.push_back(1e-3 * circle_deviation_um(shape, theta, 1.0));
    cw.push_back(1e-3 * circle_deviation_um(shape, theta, -1.0));
  }
  for (std::size_t run = 0; run < kRuns; ++run) {
    runs.ccw.push_back(ccw);
    runs.cw.push_back(cw);
    for (std::size_t i = 0; i < kPlaces; ++i) {
      runs.ccw[run][i] += 1e-3 * kScatter_um * noise(run, i);
      runs.cw[run][i] += 1e-3 * kScatter_um * noise(run, kPlaces + i);
    }
  }
  exact.ccw.theta = exact.cw.theta = runs.theta;
  exact.ccw.radial = ccw;
  exact.cw.radial = cw;
  CircleFigures figures;
  if (!circle_figures(exact, figures).ok()) return false;
  return holds(circle_intervals(runs, options.seed + campaign, options.draws).both,
               figures.circular);
}

// 60 places, stated u = 0.5 µm a component: nothing left, one far out, several equal.
bool volume_holds(std::size_t shape, const CoverageOptions& options, std::size_t campaign) {
  constexpr std::size_t kPlaces = 60;
  const Noise noise(options.seed, campaign);
  VolumeErrors volume;
  volume.u = 0.5e-3;
  double largest = 0.0;
  for (std::size_t place = 0; place < kPlaces; ++place) {
    const double size = shape == 1 && place == 7 ? 6e-3 : shape == 2 && place % 9 == 0 ? 3e-3 : 0.0;
    largest = std::max(largest, size);
    for (std::size_t c = 0; c < 3; ++c)
      volume.error.push_back((c == place % 3 ? size : 0.0) + volume.u * noise(place, c));
  }
  return holds(volume_interval(volume, options.seed + campaign, options.draws), largest);
}

bool shapes_hold(const char* name, const CoverageOptions& options,
                 bool (*one)(std::size_t, const CoverageOptions&, std::size_t)) {
  bool good = true;
  double least = 100.0;
  double most = 0.0;
  for (std::size_t shape = 0; shape < 3; ++shape) {
    const Counts held = count_held(options.campaigns, [&](std::size_t k) {
      return std::array<bool, kFigures>{one(shape, options, k)};
    });
    const double percent =
        100.0 * static_cast<double>(held[0]) / static_cast<double>(options.campaigns);
    least = std::min(least, percent);
    most = std::max(most, percent);
    good = good && enough(held[0], options.campaigns, 93.5);
  }
  fmt::print("| {} | {:.1f} … {:.1f} |\n", name, least, most);
  return good;
}

bool run(const CoverageOptions& options) {
  bool good = true;
  fmt::print(
      "{} campaigns a shape, {} draws, {} targets, s = {} µm; percent that hold the truth\n\n",
      options.campaigns, options.draws, kTargets, kSigma_um);
  fmt::print("| repeatability, runs | E | B | M | A | R |\n|---|---:|---:|---:|---:|---:|\n");
  for (const Condition& condition : kConditions) {
    const Row row = positioning_row(condition, options);
    good = good && row.good;
    fmt::print("| {} |", condition.name);
    for (std::size_t f = 0; f < kFigures; ++f)
      fmt::print(" {:.1f} … {:.1f} |", row.least.at(f), row.most.at(f));
    fmt::print("\n");
  }
  fmt::print("\n| one figure | |\n|---|---:|\n");
  good = shapes_hold("G(b), circles gone round twice", options, circle_holds) && good;
  return shapes_hold("largest error of a volume", options, volume_holds) && good;
}

}  // namespace
}  // namespace volcomp::test

int main(int argc, char** argv) {
  volcomp::test::CoverageOptions options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    const std::uint64_t value = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--campaigns") options.campaigns = value;
    if (name == "--draws") options.draws = value;
    if (name == "--seed") options.seed = value;
  }
  return volcomp::test::run(options) ? EXIT_SUCCESS : EXIT_FAILURE;
}
