#pragma once
// Intervals of the true extremes over a task. The draws about their mean are the noise of the
// nominal errors, as of any figure that is an extreme (host/measure/intervals).

#include <cstddef>
#include <optional>
#include <vector>

#include "host_sim/host/measure/intervals/interval.hpp"
#include "host_sim/host/measure/whole_way/whole_way.hpp"

namespace volcomp::host {

// All numbers of a campaign: three of each place, then the figures.
using Outputs = std::vector<double>;

// Borrows everything. Of draws that are too few, or do not differ, there is no interval.
class TrueFigures {
 public:
  TrueFigures(const Outputs& nominal, const std::vector<Outputs>& draws,
              const std::vector<PlaceUncertainty>& places);

  [[nodiscard]] std::optional<FigureInterval> largest() const;
  [[nodiscard]] std::optional<FigureInterval> range_along(const Vec3& direction) const;

 private:
  // An interval needs noise somewhere.
  [[nodiscard]] bool nothing_differs() const;
  [[nodiscard]] double noise_of(std::size_t draw, std::size_t i) const;
  // Component along a direction at each place, of three numbers a place.
  template <class Component>
  [[nodiscard]] std::vector<double> along(const Vec3& direction, const Component& component) const;

  const Outputs& nominal_;
  const std::vector<Outputs>& draws_;
  const std::vector<PlaceUncertainty>& places_;
  std::size_t count_;
};

}  // namespace volcomp::host
