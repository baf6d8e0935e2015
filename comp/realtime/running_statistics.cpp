#include "comp/realtime/running_statistics.hpp"

#include "comp/units.hpp"

namespace volcomp {

TimeLine::TimeLine(double turns_per_sample)
    : angle_(2.0 * kPi * turns_per_sample), twice_cosine_(2.0 * std::cos(angle_)) {}

SpectralLine TimeLine::line() const {
  if (n_ == 0) return {};
  const auto n = static_cast<double>(n_);
  // s_N − e^(−iω) s_(N−1) = Σ v_k e^(iω(N−1−k)); turned back to the first sample.
  const double last_angle = angle_ * (n - 1.0);
  const double re = last_ - std::cos(angle_) * before_;
  const double im = std::sin(angle_) * before_;
  const double c = std::cos(last_angle);
  const double s = std::sin(last_angle);
  double re_sum = re * c + im * s;
  double im_sum = im * c - re * s;
  // Σ e^(−iωk) = e^(−iω(N−1)/2) sin(Nω/2) / sin(ω/2), for the mean.
  const double ones = std::sin(0.5 * n * angle_) / std::sin(0.5 * angle_);
  const double mean = sum_ / n;
  re_sum -= mean * ones * std::cos(0.5 * last_angle);
  im_sum += mean * ones * std::sin(0.5 * last_angle);
  re_sum *= 2.0 / n;
  im_sum *= 2.0 / n;
  return {std::hypot(re_sum, im_sum), std::atan2(im_sum, re_sum)};
}

}  // namespace volcomp
