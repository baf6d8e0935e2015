#pragma once
// The noise that runs left in the means of one channel of an axis, as the intervals of figures draw
// it (host/measure/intervals/run_draws.hpp): its size is itself known from few runs only.

#include <cstdint>
#include <optional>
#include <vector>

#include "host_sim/host/measure/intervals/run_spread.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host {

class ChannelNoise {
 public:
  // Columns are the targets in the order of the file, of the direction up, then of down, as far as
  // there are runs. Both directions with the same number of runs, two or more: a spread that may
  // change along the travel. Otherwise one spread for the whole channel. Runs that tell nothing,
  // with fewer than kLeastFreedom degrees of freedom or all alike: `sigma` of one reading, stated,
  // mm or rad.
  ChannelNoise(const RunsFile& runs, std::size_t channel, const std::optional<double>& sigma);

  enum class From : std::uint8_t { runs, statement, nothing };
  [[nodiscard]] From from() const { return from_; }
  [[nodiscard]] std::size_t columns() const { return u_.size(); }
  // Standard deviation of what is drawn for a column: that of a scaled Student distribution, whose
  // scale also varies in shape.
  [[nodiscard]] double deviation(std::size_t column) const;
  // One draw of all columns, on RandomStream::intervals with this set-up.
  void draw(std::uint64_t seed, std::uint32_t draw, std::uint32_t set_up,
            std::vector<double>& noise) const;

  static constexpr double kLeastFreedom = 8.0;

 private:
  bool fit(const RunsFile& runs, std::size_t channel);
  bool pool(const RunsFile& runs, std::size_t channel);
  void state(const RunsFile& runs, double sigma);

  From from_ = From::runs;
  std::vector<double> u_;               // of the means, as found
  double freedom_ = 0.0;                // 0: the size is known
  std::vector<Eigen::Vector3d> shape_;  // of each column; empty: the same everywhere
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d root_ = Eigen::Matrix3d::Zero();
};

}  // namespace volcomp::host
