#include "host_sim/host/measure/intervals/volume_interval.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::host {
namespace {

NormValues vectors(std::vector<double> y) { return {3, std::move(y)}; }

// Length that the longest of `places` vectors of three standard normal numbers each exceeds in 5 of
// 100 cases.
double longest_of(std::size_t places) {
  const double one = 1.0 - std::pow(0.95, 1.0 / static_cast<double>(places));
  double low = 0.0;
  double high = 40.0;  // beyond any double
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (low + high);
    const double beyond =
        std::erfc(r / std::sqrt(2.0)) + std::sqrt(2.0 / kPi) * r * std::exp(-0.5 * r * r);
    (beyond > one ? low : high) = r;
  }
  return high;
}

}  // namespace

FigureInterval volume_interval(const VolumeErrors& volume, std::uint64_t seed, std::size_t draws) {
  constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::intervals);
  const std::size_t numbers = volume.error.size();
  const auto z = [&](std::size_t draw, std::size_t reading) {
    return normal(
        seed, {kStream, static_cast<std::uint32_t>(draw), 0, static_cast<std::uint32_t>(reading)});
  };
  const bool scaled = volume.scale > 0.0;
  NoisyDraws<NormValues> d;
  d.data = vectors(volume.error);
  double squares = 0.0;
  for (std::size_t k = 0; k < draws; ++k) {
    std::vector<double> noise(numbers);
    for (std::size_t i = 0; i < numbers; ++i)
      noise[i] = volume.u * z(k, i);
    d.high.push_back(vectors(noise));
    if (scaled) {
      const double scale = volume.scale * z(k, numbers);
      squares += scale * scale / static_cast<double>(draws);
      std::vector<double> common(numbers);
      for (std::size_t i = 0; i < numbers; ++i) {
        common[i] = scale * volume.position[i];
        noise[i] += common[i];
      }
      d.common.push_back(vectors(std::move(common)));
    }
    d.low.push_back(vectors(std::move(noise)));
  }
  d.u.assign(numbers / 3, volume.u);
  d.u_selection = d.u;
  for (std::size_t p = 0; scaled && p < d.u_selection.size(); ++p) {
    const double* const at = &volume.position[3 * p];
    const double far = std::hypot(at[0], at[1], at[2]);
    d.u_selection[p] = std::hypot(volume.u, std::sqrt(squares) * far);
  }
  return interval_of(d);
}

std::size_t affordable_draws(std::size_t places, std::size_t wanted) {
  constexpr std::size_t kMost = 2'000'000;  // draws times places
  constexpr std::size_t kFewest = 400;
  if (places > kMost / kFewest) return 0;
  return std::min(wanted, kMost / std::max<std::size_t>(places, 1));
}

FigureInterval widest_volume_interval(const VolumeErrors& volume) {
  const double figure = vectors(volume.error).figure();
  const double noise = volume.u * longest_of(volume.error.size() / 3);
  return {figure, figure, std::max(0.0, figure - noise), figure + noise, figure + noise};
}

}  // namespace volcomp::host
