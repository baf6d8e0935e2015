#include "host_sim/host/measure/intervals/circle_interval.hpp"

#include <cmath>
#include <iterator>

#include "comp/metrology/circles/centred_fit.hpp"
#include "comp/metrology/circles/circle_figures.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/intervals/run_draws.hpp"

namespace volcomp::host {
namespace {

// Deviations of the radius of a path, about its own centre, in the order of the angles: of both
// directions about their common one.
Columns about_own_centre(const CircleTest& test) {
  CircleFigures figures;
  Columns p(0.0, test.ccw.theta.size() + test.cw.theta.size());
  if (!circle_figures(test, figures).ok()) return p;
  const Eigen::Vector2d centre(figures.centre[0], figures.centre[1]);
  std::size_t i = 0;
  for_each_reading(test, [&](double theta, double radial, double /*sense*/) {
    p[i++] = path_deviation(test.radius, theta, radial, centre);
  });
  return p;
}

// Noise of the means by column, ccw and then cw.
struct MeanNoise {
  Columns u;
  std::vector<Columns> draw;
};

MeanNoise stated_noise(const CircleRuns& runs, std::uint64_t seed, std::size_t draws) {
  constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::intervals);
  const std::size_t q = 2 * runs.theta.size();
  MeanNoise noise;
  noise.u = Columns(runs.sigma / std::sqrt(static_cast<double>(runs.ccw.size())), q);
  for (std::size_t k = 0; k < draws; ++k) {
    Columns e(q);
    for (std::size_t j = 0; j < q; ++j)
      e[j] = noise.u[j] * normal(seed, {kStream, static_cast<std::uint32_t>(k), 0,
                                        static_cast<std::uint32_t>(j)});
    noise.draw.push_back(std::move(e));
  }
  return noise;
}

MeanNoise noise_of_runs(const RunReadings& readings, std::uint64_t seed, std::size_t draws) {
  const RunSpread spread = run_spread(readings);
  const RunDraws source(readings, spread, {}, seed, draws);
  MeanNoise noise;
  noise.u = std::sqrt(spread.v / static_cast<double>(readings.run.size()));
  for (std::size_t k = 0; k < draws; ++k)
    noise.draw.push_back(source.draw(k).mean);
  return noise;
}

FigureInterval range_of(const Columns& p, const MeanNoise& noise, std::size_t first) {
  const std::slice part(first, p.size(), 1);
  const auto values = [](const Columns& v) {
    const std::vector<double> list(std::begin(v), std::end(v));
    return SpanValues{list, list};
  };
  NoisyDraws<SpanValues> draws;
  draws.data = values(p);
  draws.u = values(noise.u[part]).upper;
  draws.u_selection = draws.u;
  for (const Columns& e : noise.draw)
    draws.low.push_back(values(e[part]));
  draws.high = draws.low;
  return interval_of(draws);
}

}  // namespace

CircleIntervals circle_intervals(const CircleRuns& runs, std::uint64_t seed, std::size_t draws) {
  const std::size_t m = runs.theta.size();
  const auto n = static_cast<double>(runs.ccw.size());
  RunReadings both{runs.theta, {}};
  Columns ccw(0.0, m);
  Columns cw(0.0, m);
  for (std::size_t j = 0; j < runs.ccw.size(); ++j) {
    const CircleTrace there{runs.theta, runs.ccw[j]};
    const CircleTrace back{runs.theta, runs.cw[j]};
    both.run.push_back(about_own_centre({runs.radius, there, back}));
    ccw += about_own_centre({runs.radius, there, {}}) / n;
    cw += about_own_centre({runs.radius, {}, back}) / n;
  }
  const MeanNoise noise =
      runs.sigma > 0.0 ? stated_noise(runs, seed, draws) : noise_of_runs(both, seed, draws);
  return {range_of(ccw, noise, 0), range_of(cw, noise, m), range_of(both.mean(), noise, 0)};
}

}  // namespace volcomp::host
