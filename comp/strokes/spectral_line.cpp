#include "comp/strokes/spectral_line.hpp"

#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {

SpectralLine spectral_line(const OrderLine& sums) {
  if (sums.n == 0) return {};
  const auto n = static_cast<double>(sums.n);
  const double mean = sums.sum / n;
  const double re = 2.0 / n * (sums.with_cosine - mean * sums.cosines);
  const double im = -2.0 / n * (sums.with_sine - mean * sums.sines);
  return {std::hypot(re, im), std::atan2(im, re)};
}

SpectralLine spectral_line(const TimeLine& sums) {
  if (sums.n == 0 || !(sums.angle > 0.0)) return {};
  const auto n = static_cast<double>(sums.n);
  // s_N − e^(−iω) s_(N−1) = Σ v_k e^(iω(N−1−k)); turned back to the first sample.
  const double last_angle = sums.angle * (n - 1.0);
  const double re = sums.last - std::cos(sums.angle) * sums.before;
  const double im = std::sin(sums.angle) * sums.before;
  const double c = std::cos(last_angle);
  const double s = std::sin(last_angle);
  // The mean: Σ e^(−iωk) = e^(−iω(N−1)/2) sin(Nω/2) / sin(ω/2).
  const double ones = sums.sum / n * std::sin(0.5 * n * sums.angle) / std::sin(0.5 * sums.angle);
  const double re_line = 2.0 / n * (re * c + im * s - ones * std::cos(0.5 * last_angle));
  const double im_line = 2.0 / n * (im * c - re * s + ones * std::sin(0.5 * last_angle));
  return {std::hypot(re_line, im_line), std::atan2(im_line, re_line)};
}

SpectralLine order_around(Span<const NodeSums> slots, int order) {
  OrderLine line;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (slots[k].n == 0) continue;
    const double angle =
        2.0 * kPi * order * static_cast<double>(k) / static_cast<double>(slots.size());
    line.add(slots[k].sum / static_cast<double>(slots[k].n), std::cos(angle), std::sin(angle));
  }
  return spectral_line(line);
}

}  // namespace volcomp
