#include "host_sim/host/measure/whole_way/true_figures.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/measure/intervals/volume_interval.hpp"

namespace volcomp::host {

TrueFigures::TrueFigures(const Outputs& nominal, const std::vector<Outputs>& draws,
                         const std::vector<PlaceUncertainty>& places)
    : nominal_(nominal),
      draws_(draws),
      places_(places),
      count_(affordable_draws(places.size(), draws.size())) {}

bool TrueFigures::nothing_differs() const {
  return std::all_of(places_.begin(), places_.end(), [](const PlaceUncertainty& p) {
    return std::all_of(p.error.begin(), p.error.end(),
                       [](const DrawnNumber& e) { return !(e.deviation > 0.0); });
  });
}

double TrueFigures::noise_of(std::size_t draw, std::size_t i) const {
  return draws_[draw][i] - places_[i / 3].error.at(i % 3).mean;
}

std::optional<FigureInterval> TrueFigures::largest() const {
  if (count_ < kFewestDraws || nothing_differs()) return std::nullopt;
  const std::size_t numbers = 3 * places_.size();
  NoisyDraws<NormValues> d;
  d.data = {3, {nominal_.begin(), nominal_.begin() + static_cast<std::ptrdiff_t>(numbers)}};
  for (const PlaceUncertainty& p : places_) {
    double squares = 0.0;
    for (const DrawnNumber& e : p.error)
      squares += e.deviation * e.deviation / 3.0;
    d.u.push_back(std::sqrt(squares));
  }
  for (std::size_t k = 0; k < count_; ++k) {
    NormValues noise{3, {}};
    for (std::size_t i = 0; i < numbers; ++i)
      noise.y.push_back(noise_of(k, i));
    d.low.push_back(noise);
  }
  d.high = d.low;
  d.u_selection = d.u;
  return interval_of(d);
}

template <class Component>
std::vector<double> TrueFigures::along(const Vec3& direction, const Component& component) const {
  std::vector<double> values;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      sum += direction(static_cast<Eigen::Index>(c)) * component(3 * p + c);
    values.push_back(sum);
  }
  return values;
}

std::optional<FigureInterval> TrueFigures::range_along(const Vec3& direction) const {
  if (count_ < kFewestDraws || nothing_differs()) return std::nullopt;
  NoisyDraws<SpanValues> d;
  const std::vector<double> data = along(direction, [&](std::size_t i) { return nominal_[i]; });
  d.data = {data, data};
  std::vector<double> squares(places_.size(), 0.0);
  for (std::size_t k = 0; k < count_; ++k) {
    const std::vector<double> noise =
        along(direction, [&](std::size_t i) { return noise_of(k, i); });
    for (std::size_t p = 0; p < noise.size(); ++p)
      squares[p] += noise[p] * noise[p];
    d.low.push_back({noise, noise});
  }
  for (const double s : squares)
    d.u.push_back(std::sqrt(s / static_cast<double>(count_)));
  d.high = d.low;
  d.u_selection = d.u;
  return interval_of(d);
}

}  // namespace volcomp::host
