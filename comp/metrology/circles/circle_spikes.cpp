#include <algorithm>
#include <cmath>
#include <limits>

#include "comp/metrology/circles/circle_decomposition.hpp"

namespace volcomp {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kBorder = 1e-9 * kDegree;

// Readings of a travel between two angles from a reversal on.
class Window {
 public:
  Window(Span<const double> theta, Span<const double> residual, double from, double to)
      : theta_(theta), residual_(residual), from_(from - kBorder), to_(to + kBorder) {}

  // Calls visit(residual) for the readings within.
  template <class Visit>
  void for_each(double reversal, const Visit& visit) const {
    const double sense = theta_[theta_.size() - 1] > theta_[0] ? 1.0 : -1.0;
    for (std::size_t i = 0; i < theta_.size(); ++i) {
      const double travelled = std::remainder(sense * (theta_[i] - reversal), 360.0 * kDegree);
      if (travelled >= from_ && travelled <= to_) visit(residual_[i]);
    }
  }
  [[nodiscard]] std::size_t count(double reversal) const {
    std::size_t n = 0;
    for_each(reversal, [&n](double) { ++n; });
    return n;
  }
  // Of at least one reading. Found by counting: nothing is stored.
  [[nodiscard]] double median(double reversal) const {
    const std::size_t n = count(reversal);
    const double low = ranked(reversal, (n - 1) / 2);
    return n % 2 == 1 ? low : 0.5 * (low + ranked(reversal, n / 2));
  }

 private:
  // The value with `rank` smaller ones before it.
  [[nodiscard]] double ranked(double reversal, std::size_t rank) const {
    double value = -std::numeric_limits<double>::infinity();
    std::size_t below = 0;
    while (below <= rank) {
      double next = std::numeric_limits<double>::infinity();
      std::size_t alike = 0;
      for_each(reversal, [&](double x) {
        if (x <= value || x > next) return;
        alike = x < next ? 1 : alike + 1;
        next = x;
      });
      value = next;
      below += alike;
    }
    return value;
  }

  Span<const double> theta_;
  Span<const double> residual_;
  double from_;
  double to_;
};

}  // namespace

std::array<CircleSpike, 4> circle_spikes(Span<const double> theta, Span<const double> residual) {
  constexpr std::size_t kLeast = 3;
  std::array<CircleSpike, 4> spikes{};
  if (theta.empty() || theta.size() != residual.size()) return spikes;
  const Window before(theta, residual, -20.0 * kDegree, -10.0 * kDegree - 2.0 * kBorder);
  const Window spike(theta, residual, 0.0, 10.0 * kDegree);
  const Window after(theta, residual, 10.0 * kDegree + 2.0 * kBorder, 20.0 * kDegree);
  for (std::size_t i = 0; i < spikes.size(); ++i) {
    const double reversal = 90.0 * kDegree * static_cast<double>(i);
    if (before.count(reversal) < kLeast || spike.count(reversal) < kLeast ||
        after.count(reversal) < kLeast) {
      continue;
    }
    const double level = 0.5 * (before.median(reversal) + after.median(reversal));
    double height = 0.0;
    spike.for_each(reversal, [&](double x) {
      if (std::abs(x - level) > std::abs(height)) height = x - level;
    });
    spikes[i] = {height, true};
  }
  return spikes;
}

}  // namespace volcomp
