#pragma once
// Draws of the noise that runs left in their means and in their spread.

#include <cstddef>
#include <cstdint>

#include "host_sim/host/measure/intervals/run_spread.hpp"

namespace volcomp::host {

// What no run can tell, stated; the unit of the readings.
struct StatedErrors {
  double scale = 0.0;  // standard uncertainty of the instrument's scale, a mm of position
  double drift = 0.0;  // range of a drift test (EVE)
};

// One draw, by column.
struct RunDraw {
  Columns mean;         // noise of the means
  Columns common;       // stated errors
  Columns spread_low;   // what is added to σ̂, over σ̂: for the lower end of an interval
  Columns spread_high;  // and for the upper end
};

// Numbers of RandomStream::intervals. `readings` and `spread` must outlive it.
class RunDraws {
 public:
  RunDraws(const RunReadings& readings, const RunSpread& spread, const StatedErrors& stated,
           std::uint64_t seed, std::size_t count);

  // What whole runs share, where 5 of 100 campaigns or fewer show as much by chance; else 0.
  [[nodiscard]] double shared() const { return shared_; }
  [[nodiscard]] bool anything_stated() const { return stated_.scale > 0.0 || stated_.drift > 0.0; }
  [[nodiscard]] RunDraw draw(std::size_t k) const;

 private:
  [[nodiscard]] double z(std::size_t draw, std::size_t reading) const;
  [[nodiscard]] double common_factor(std::size_t k) const;
  [[nodiscard]] double squares(std::size_t k, std::size_t count) const;
  [[nodiscard]] bool runs_differ() const;
  [[nodiscard]] double drift(std::size_t k, std::size_t first) const;
  [[nodiscard]] Columns common(std::size_t k) const;

  const RunReadings& readings_;
  const RunSpread& spread_;
  StatedErrors stated_;
  std::uint64_t seed_;
  std::size_t count_;
  std::size_t n_;  // runs
  std::size_t q_;  // columns
  Eigen::Matrix3d root_;
  double shared_;
};

}  // namespace volcomp::host
