#include "host_sim/host/measure/intervals/run_draws.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::host {
namespace {

// Chosen by looking at coverage: how much of the shape of the spread counts for the lower end of A
// and R.
constexpr double kShape = 0.3;

}  // namespace

RunDraws::RunDraws(const RunReadings& readings, const RunSpread& spread, const StatedErrors& stated,
                   std::uint64_t seed, std::size_t count)
    : readings_(readings),
      spread_(spread),
      stated_(stated),
      seed_(seed),
      count_(count),
      n_(readings.run.size()),
      q_(readings.columns()),
      root_(Eigen::LLT<Eigen::Matrix3d>(spread.covariance).matrixL()),
      shared_(runs_differ() ? spread.run : 0.0) {}

double RunDraws::z(std::size_t draw, std::size_t reading) const {
  constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::intervals);
  return normal(
      seed_, {kStream, static_cast<std::uint32_t>(draw), 0, static_cast<std::uint32_t>(reading)});
}

// Spread as it may be, over as it was found.
double RunDraws::common_factor(std::size_t k) const {
  return std::sqrt(spread_.freedom / chi_square(spread_.freedom, z(k, q_)));
}

// Of the numbers behind all others of a draw.
double RunDraws::squares(std::size_t k, std::size_t count) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    sum += std::pow(z(k, q_ + 5 + 2 * n_ + i), 2);
  return sum;
}

bool RunDraws::runs_differ() const {
  const auto q = static_cast<double>(q_);
  const double ratio = q * spread_.total / spread_.pooled - (q - 1.0);
  std::size_t as_large = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const double c = common_factor(k);
    if (c * c * squares(k, n_ - 1) / static_cast<double>(n_ - 1) >= ratio) ++as_large;
  }
  return static_cast<double>(as_large) < 0.05 * static_cast<double>(count_);
}

// Rectangular between −½ and ½, mean over the runs of a direction.
double RunDraws::drift(std::size_t k, std::size_t first) const {
  double sum = 0.0;
  for (std::size_t j = 0; j < n_; ++j)
    sum += 0.5 * std::erf(z(k, first + j) / std::sqrt(2.0));
  return sum / static_cast<double>(n_);
}

Columns RunDraws::common(std::size_t k) const {
  const std::size_t m = q_ / 2;
  Columns out(0.0, q_);
  if (!anything_stated()) return out;
  const double scale = stated_.scale * z(k, q_ + 4);
  const double up = stated_.drift * drift(k, q_ + 5);
  const double down = stated_.drift * drift(k, q_ + 5 + n_);
  for (std::size_t j = 0; j < m; ++j) {
    const double shared = scale * readings_.position[j];
    out[j] = shared + up;
    out[m + j] = shared + down;
  }
  return out;
}

RunDraw RunDraws::draw(std::size_t k) const {
  const double c = common_factor(k);
  const Eigen::Vector3d bent = root_ * Eigen::Vector3d(z(k, q_ + 1), z(k, q_ + 2), z(k, q_ + 3));
  Columns h(q_);
  RunDraw d;
  d.mean.resize(q_);
  for (std::size_t j = 0; j < q_; ++j) {
    h[j] = std::exp(0.5 * spread_.shape[j].dot(bent));
    d.mean[j] = z(k, j) * std::sqrt(spread_.v[j] / static_cast<double>(n_)) * c * h[j];
  }
  // Three degrees of freedom more than runs have: with two runs one alone would give limits that
  // are 80 times too wide.
  const double w = shared_ / (1.0 + shared_);
  const double runs = static_cast<double>(n_ + 2) / squares(k, n_ + 2);
  const double both = std::sqrt((1.0 - w) * c * c + w * runs);
  d.spread_low = kShape * (h - 1.0) + (1.0 - both);
  d.spread_high = 1.0 - both * h;
  d.common = common(k);
  return d;
}

}  // namespace volcomp::host
