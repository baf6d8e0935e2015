#include "host_sim/sim/instruments/bidirectional_runs.hpp"

#include <fmt/format.h>

namespace volcomp::sim {

host::RunsFile bidirectional_runs(char letter, const std::vector<double>& positions,
                                  std::size_t runs,
                                  const std::function<ErrorMotion(const Stop&)>& reading) {
  host::RunsFile result;
  result.name = fmt::format("runs_{}.csv", letter);
  result.letter = letter;
  result.positions = positions;
  const std::size_t n = positions.size();
  // Before the first reading the slide has stood at the first target.
  Stop stop{positions.front(), 1.0, positions.front(), 1.0, 0};
  const auto run = [&](double approach) {
    host::RunValues values(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t t = approach > 0.0 ? i : n - 1 - i;
      stop.q = positions[t];
      stop.approach = approach;
      values[t] = reading(stop);
      stop = {stop.q, approach, stop.q, approach, stop.number + 1};
    }
    return values;
  };
  for (std::size_t r = 0; r < runs; ++r) {
    result.up.push_back(run(1.0));
    result.down.push_back(run(-1.0));
  }
  return result;
}

std::vector<ErrorMotion> mean_of_runs(const host::RunsFile& runs) {
  std::vector<ErrorMotion> mean(runs.positions.size(), ErrorMotion::Zero());
  const auto n = static_cast<double>(runs.up.size() + runs.down.size());
  for (const auto* list : {&runs.up, &runs.down}) {
    for (const host::RunValues& run : *list) {
      for (std::size_t t = 0; t < run.size(); ++t)
        mean[t] += run[t] / n;
    }
  }
  return mean;
}

}  // namespace volcomp::sim
