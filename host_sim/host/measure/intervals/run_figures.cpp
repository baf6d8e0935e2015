#include "host_sim/host/measure/intervals/run_figures.hpp"

#include <algorithm>
#include <cmath>

#include "comp/metrology/tables/diagonals.hpp"

namespace volcomp::host {
namespace {

// Mean and standard deviation (n − 1) of the runs of one direction, by target.
struct Direction {
  std::vector<double> mean;
  std::vector<double> deviation;
};

Direction statistics(const std::vector<std::vector<double>>& runs) {
  Direction s;
  if (runs.empty()) return s;
  std::vector<double> squares(runs.front().size(), 0.0);
  s.mean.assign(squares.size(), 0.0);
  s.deviation.assign(squares.size(), 0.0);
  // Welford's way: no difference of large sums.
  double count = 0.0;
  for (const std::vector<double>& run : runs) {
    count += 1.0;
    for (std::size_t t = 0; t < run.size(); ++t) {
      const double before = run[t] - s.mean[t];
      s.mean[t] += before / count;
      squares[t] += before * (run[t] - s.mean[t]);
    }
  }
  if (runs.size() < 2) return s;
  for (std::size_t t = 0; t < squares.size(); ++t)
    s.deviation[t] = std::sqrt(squares[t] / (count - 1.0));
  return s;
}

}  // namespace

Status run_figures(const std::vector<std::vector<double>>& up_runs,
                   const std::vector<std::vector<double>>& down_runs, RunFigures& out) {
  Direction up = statistics(up_runs);
  Direction down = statistics(down_runs);
  RunFigures f;
  f.both_directions = !up_runs.empty() && !down_runs.empty();
  f.runs = f.both_directions ? std::min(up_runs.size(), down_runs.size())
                             : std::max(up_runs.size(), down_runs.size());
  if (up_runs.empty()) up = down;
  if (down_runs.empty()) down = up;
  const Status status = iso230_figures({up.mean, up.deviation}, {down.mean, down.deviation}, f.iso);
  if (!status.ok()) return status;
  const double first = 0.5 * (up.mean[0] + down.mean[0]);
  for (std::size_t t = 0; t < up.mean.size(); ++t)
    f.curve.push_back(0.5 * (up.mean[t] + down.mean[t]) - first);
  f.largest = diagonal_figures({f.curve.data(), f.curve.size()}).max_abs;
  out = std::move(f);
  return {};
}

}  // namespace volcomp::host
