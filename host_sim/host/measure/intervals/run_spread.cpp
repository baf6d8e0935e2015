#include "host_sim/host/measure/intervals/run_spread.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace volcomp::host {
namespace {

using Design = std::vector<Eigen::Vector4d>;

double mean_of(const Columns& x) { return x.sum() / static_cast<double>(x.size()); }

// 1, Legendre's P₁ and P₂ along the travel, ±1 for the direction.
Design design_of(const std::vector<double>& position) {
  const double first = position.front();
  const double travel = position.back() - first;
  Design design;
  for (const double direction : {1.0, -1.0}) {
    for (const double at : position) {
      const double t = 2.0 * (at - first) / travel - 1.0;
      design.emplace_back(1.0, t, 1.5 * t * t - 0.5, direction);
    }
  }
  return design;
}

// Largest likelihood of variances that are σ²χ²/d, with a ridge N(0, 1) on all but the level.
class VarianceFit {
 public:
  VarianceFit(Design design, Columns v, double freedom)
      : design_(std::move(design)), v_(std::move(v)), freedom_(freedom) {
    Eigen::Matrix4d information = ridge_.asDiagonal();
    for (const Eigen::Vector4d& row : design_)
      information += 0.5 * freedom_ * row * row.transpose();
    inverse_ = information.inverse();
    b_ << std::log(mean_of(v_)), 0.0, 0.0, 0.0;
    solve();
  }
  [[nodiscard]] const Eigen::Vector4d& b() const { return b_; }
  [[nodiscard]] const Eigen::Matrix4d& covariance() const { return inverse_; }
  // Scaled so that v over it is 1 in the mean.
  [[nodiscard]] Columns fitted() const {
    const Columns sigma2 = variances();
    return sigma2 * mean_of(v_ / sigma2);
  }

 private:
  [[nodiscard]] Columns variances() const {
    Columns out(v_.size());
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = std::exp(design_[k].dot(b_));
    return out;
  }
  // Fisher scoring; the information is the same everywhere.
  void solve() {
    constexpr int kMostSteps = 1000;
    constexpr double kConverged = 1e-12;
    for (int step = 0; step < kMostSteps; ++step) {
      const Columns ratio = v_ / variances();
      Eigen::Vector4d slope = -ridge_.cwiseProduct(b_);
      for (std::size_t k = 0; k < ratio.size(); ++k)
        slope += 0.5 * freedom_ * (ratio[k] - 1.0) * design_[k];
      Eigen::Vector4d move = inverse_ * slope;
      const double longest = move.cwiseAbs().maxCoeff();
      if (longest > 1.0) move /= longest;
      b_ += move;
      if (longest < kConverged) return;
    }
  }

  Design design_;
  Columns v_;
  double freedom_;
  Eigen::Vector4d ridge_{0.0, 1.0, 1.0, 1.0};
  Eigen::Matrix4d inverse_;
  Eigen::Vector4d b_;
};

}  // namespace

Columns RunReadings::mean() const {
  Columns sum(0.0, columns());
  for (const Columns& one : run)
    sum += one;
  return sum / static_cast<double>(run.size());
}

RunSpread run_spread(const RunReadings& readings) {
  const auto n = static_cast<double>(readings.run.size());
  const auto q = static_cast<double>(readings.columns());
  const double freedom = (n - 1.0) * (q - 1.0) / q;  // of a column, its run's mean taken out
  const Columns mean = readings.mean();
  Columns v(0.0, readings.columns());
  double squares = 0.0;
  for (const Columns& one : readings.run) {
    const Columns about_mean = one - mean;
    const Columns about_run = about_mean - mean_of(about_mean);
    squares += (about_mean * about_mean).sum();
    v += about_run * about_run / freedom;
  }
  RunSpread s;
  s.freedom = (n - 1.0) * (q - 1.0);
  s.pooled = mean_of(v);
  s.total = squares / (n - 1.0) / q;
  s.run = std::max(0.0, s.total / s.pooled - 1.0);
  const Design design = design_of(readings.position);
  const VarianceFit fit(design, v, freedom);
  s.coefficients = fit.b().tail<3>();
  s.covariance = fit.covariance().bottomRightCorner<3, 3>();
  for (const Eigen::Vector4d& row : design)
    s.shape.emplace_back(row.tail<3>());
  s.v = fit.fitted();
  return s;
}

}  // namespace volcomp::host
