#include "host_sim/host/measure/whole_way/channel_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/intervals/run_check.hpp"

namespace volcomp::host {
namespace {

// One channel of the runs of a direction, by run and target.
std::vector<std::vector<double>> channel_of(const std::vector<RunValues>& runs,
                                            std::size_t channel) {
  std::vector<std::vector<double>> out;
  for (const RunValues& run : runs) {
    out.emplace_back();
    for (const ErrorMotion& reading : run)
      out.back().push_back(reading(static_cast<Eigen::Index>(channel)));
  }
  return out;
}

// Σ (x − mean of its target)², and whether it is more than the rounding of the readings.
struct Scatter {
  double squares = 0.0;
  double largest = 0.0;

  [[nodiscard]] bool shows(double freedom) const {
    constexpr double kRounding = 1e-12;
    return std::sqrt(squares / freedom) > kRounding * largest;
  }
};

void add_scatter(const std::vector<std::vector<double>>& runs, Scatter& scatter) {
  for (std::size_t t = 0; !runs.empty() && t < runs.front().size(); ++t) {
    double mean = 0.0;
    for (const std::vector<double>& run : runs) {
      mean += run[t] / static_cast<double>(runs.size());
      scatter.largest = std::max(scatter.largest, std::abs(run[t]));
    }
    for (const std::vector<double>& run : runs)
      scatter.squares += (run[t] - mean) * (run[t] - mean);
  }
}

// `sigma` of a reading for every column, over the root of the runs of its direction.
std::vector<double> of_means(const RunsFile& runs, double sigma) {
  std::vector<double> u;
  for (const std::vector<RunValues>* direction : {&runs.up, &runs.down}) {
    if (direction->empty()) continue;
    u.insert(u.end(), runs.positions.size(),
             sigma / std::sqrt(static_cast<double>(direction->size())));
  }
  return u;
}

}  // namespace

ChannelNoise::ChannelNoise(const RunsFile& runs, std::size_t channel,
                           const std::optional<double>& sigma) {
  if (fit(runs, channel) || pool(runs, channel)) return;
  from_ = sigma ? From::statement : From::nothing;
  state(runs, sigma.value_or(0.0));
}

bool ChannelNoise::fit(const RunsFile& runs, std::size_t channel) {
  const auto up = channel_of(runs.up, channel);
  const auto down = channel_of(runs.down, channel);
  std::vector<double> rising = runs.positions;
  std::sort(rising.begin(), rising.end());
  if (!check_runs(rising, up, down).ok()) return false;
  RunReadings readings;
  readings.position = runs.positions;  // falling ones only turn the shape round
  for (std::size_t r = 0; r < up.size(); ++r) {
    Columns one(readings.columns());
    for (std::size_t t = 0; t < runs.positions.size(); ++t) {
      one[t] = up[r][t];
      one[runs.positions.size() + t] = down[r][t];
    }
    readings.run.push_back(one);
  }
  const RunSpread spread = run_spread(readings);
  if (spread.freedom < kLeastFreedom) return false;
  freedom_ = spread.freedom;
  shape_ = spread.shape;
  covariance_ = spread.covariance;
  root_ = Eigen::LLT<Eigen::Matrix3d>(spread.covariance).matrixL();
  for (const double v : spread.v)
    u_.push_back(std::sqrt(v / static_cast<double>(up.size())));
  return true;
}

// What whole runs share stays in: with different numbers of runs it does not cancel.
bool ChannelNoise::pool(const RunsFile& runs, std::size_t channel) {
  if (runs.up.size() == runs.down.size()) return false;
  Scatter scatter;
  double freedom = 0.0;
  for (const std::vector<RunValues>* direction : {&runs.up, &runs.down}) {
    if (direction->empty()) continue;
    add_scatter(channel_of(*direction, channel), scatter);
    freedom +=
        static_cast<double>(direction->size() - 1) * static_cast<double>(runs.positions.size());
  }
  if (freedom < kLeastFreedom || !scatter.shows(freedom)) return false;
  freedom_ = freedom;
  u_ = of_means(runs, std::sqrt(scatter.squares / freedom));
  return true;
}

void ChannelNoise::state(const RunsFile& runs, double sigma) { u_ = of_means(runs, sigma); }

double ChannelNoise::deviation(std::size_t column) const {
  double factor = freedom_ > 0.0 ? freedom_ / (freedom_ - 2.0) : 1.0;
  if (!shape_.empty())  // mean of exp(x·b), b of the covariance
    factor *= std::exp(0.5 * shape_[column].dot(covariance_ * shape_[column]));
  return u_[column] * std::sqrt(factor);
}

void ChannelNoise::draw(std::uint64_t seed, std::uint32_t draw, std::uint32_t set_up,
                        std::vector<double>& noise) const {
  const std::size_t q = columns();
  const auto z = [&](std::size_t reading) {
    constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::intervals);
    return normal(seed, {kStream, draw, set_up, static_cast<std::uint32_t>(reading)});
  };
  const double c = freedom_ > 0.0 ? std::sqrt(freedom_ / chi_square(freedom_, z(q))) : 1.0;
  Eigen::Vector3d bent = Eigen::Vector3d::Zero();
  if (!shape_.empty()) bent = root_ * Eigen::Vector3d(z(q + 1), z(q + 2), z(q + 3));
  noise.resize(q);
  for (std::size_t j = 0; j < q; ++j) {
    const double h = shape_.empty() ? 1.0 : std::exp(0.5 * shape_[j].dot(bent));
    noise[j] = u_[j] * z(j) * c * h;
  }
}

}  // namespace volcomp::host
