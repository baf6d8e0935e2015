#include "host_sim/host/measure/intervals/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace volcomp::host {
namespace {

constexpr int kHalvings = 40;

// The border between where `holds` is false (below) and true, or the other way round, in 0…top: the
// middle of the last of the halvings.
double border(double top, const std::function<bool(double)>& is_below) {
  double low = 0.0;
  double high = top;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (is_below(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add(std::vector<double>& to, const std::vector<double>& what, double by) {
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] += by * what[i];
}
void add(SpanValues& to, const SpanValues& what, double by = 1.0) {
  add(to.upper, what.upper, by);
  add(to.lower, what.lower, by);
}
void add(PeakValues& to, const PeakValues& what, double by = 1.0) { add(to.y, what.y, by); }
void add(NormValues& to, const NormValues& what, double by = 1.0) { add(to.y, what.y, by); }

// Figures of `values` with `noise` added, without making the sum: this is where the time goes.
double figure_with(const SpanValues& values, const SpanValues& noise) {
  double largest = values.upper[0] + noise.upper[0];
  double least = values.lower[0] + noise.lower[0];
  for (std::size_t i = 0; i < values.upper.size(); ++i) {
    largest = std::max(largest, values.upper[i] + noise.upper[i]);
    least = std::min(least, values.lower[i] + noise.lower[i]);
  }
  return largest - least;
}
double figure_with(const PeakValues& values, const PeakValues& noise) {
  double largest = values.y[0] + noise.y[0];
  for (std::size_t i = 1; i < values.y.size(); ++i)
    largest = std::max(largest, values.y[i] + noise.y[i]);
  return largest;
}
double figure_with(const NormValues& values, const NormValues& noise) {
  double largest = 0.0;
  for (std::size_t i = 0; i < values.y.size(); i += values.components) {
    double squares = 0.0;
    for (std::size_t k = i; k < i + values.components; ++k) {
      const double sum = values.y[k] + noise.y[k];
      squares += sum * sum;
    }
    largest = std::max(largest, squares);
  }
  return std::sqrt(largest);
}

// Whether the figure of lonely_with(…, figure) and noise rises with `figure`, whatever the noise.
template <class Values>
constexpr bool kRises = !std::is_same_v<Values, NormValues>;

// Shares of draws whose common errors are taken off the data: every draw has data of its own, and
// an edge of its own to be found. What rises with the figure needs few of the comparisons.
template <class Values>
class ShareOfCleared {
 public:
  ShareOfCleared(const NoisyDraws<Values>& draws, std::vector<Values> cleared)
      : draws_(draws), cleared_(std::move(cleared)), known_(cleared_.size()) {
    for (const Values& data : cleared_)
      figure_.push_back(data.figure());
  }
  [[nodiscard]] double largest() const { return *std::max_element(figure_.begin(), figure_.end()); }
  // In which the data have no less than the truth has.
  [[nodiscard]] std::size_t hits(double figure) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < cleared_.size(); ++k)
      count += is_hit(k, figure) ? 1U : 0U;
    return count;
  }

 private:
  struct Known {
    double hit = -1.0;                                      // the largest figure known to be one
    double miss = std::numeric_limits<double>::infinity();  // the smallest known to be none
  };

  bool is_hit(std::size_t k, double figure) {
    Known& known = known_[k];
    if (kRises<Values> && figure <= known.hit) return true;
    if (kRises<Values> && figure >= known.miss) return false;
    const Values truth = lonely_with(cleared_[k], figure, draws_.u);
    const bool hit = figure_with(truth, draws_.high[k]) <= figure_[k];
    (hit ? known.hit : known.miss) = figure;
    return hit;
  }

  const NoisyDraws<Values>& draws_;
  std::vector<Values> cleared_;
  std::vector<double> figure_;
  std::vector<Known> known_;
};

double share_of(std::size_t hits, std::size_t draws) {
  return static_cast<double>(hits) / static_cast<double>(draws);
}

}  // namespace

FigureInterval interval_from(double estimate, double top, const ShareOfDraws& share) {
  constexpr double kLow = 0.04;
  constexpr double kHigh = 0.01;
  constexpr double kOneSided = 0.05;
  constexpr int kMostDoublings = 60;
  FigureInterval i;
  i.estimate = estimate;
  for (int k = 0; k < kMostDoublings && share.high(top) > kHigh; ++k)
    top *= 2.0;
  const auto rising = [&](double wanted) {
    if (share.low(0.0) > wanted) return 0.0;
    return border(top, [&](double figure) { return !(share.low(figure) > wanted); });
  };
  const auto falling = [&](double wanted) {
    if (share.high(0.0) < wanted) return 0.0;
    return border(top, [&](double figure) { return share.high(figure) >= wanted; });
  };
  i.corrected = rising(0.5);
  i.low = std::min(rising(kLow), i.corrected);
  i.high = std::max(falling(kHigh), i.corrected);
  i.upper95 = std::max(falling(kOneSided), i.corrected);
  return i;
}

template <class Values>
FigureInterval interval_of(const NoisyDraws<Values>& draws) {
  constexpr double kSmall = 1e-12;  // of the unit of the values, µm
  const double estimate = draws.data.figure();
  ShareOfDraws share;
  share.low = [&](double figure) {
    const Values truth = nearest_with(draws.data, figure, draws.u_selection);
    std::size_t hits = 0;
    for (const Values& noise : draws.low)
      hits += figure_with(truth, noise) >= estimate ? 1U : 0U;
    return share_of(hits, draws.low.size());
  };
  if (draws.common.empty()) {
    share.high = [&](double figure) {
      const Values truth = lonely_with(draws.data, figure, draws.u);
      std::size_t hits = 0;
      for (const Values& noise : draws.high)
        hits += figure_with(truth, noise) <= estimate ? 1U : 0U;
      return share_of(hits, draws.high.size());
    };
    return interval_from(estimate, 2.0 * estimate + kSmall, share);
  }
  // The lower end takes the data as they are, common errors among the noise; the upper end takes
  // the common errors of every draw off the data (R. D. Cousins, V. L. Highland, 1992).
  std::vector<Values> cleared(draws.common.size(), draws.data);
  for (std::size_t k = 0; k < cleared.size(); ++k)
    add(cleared[k], draws.common[k], -1.0);
  ShareOfCleared<Values> of_cleared(draws, std::move(cleared));
  const double largest = std::max(estimate, of_cleared.largest());
  share.high = [&](double figure) { return share_of(of_cleared.hits(figure), draws.high.size()); };
  return interval_from(estimate, 2.0 * largest + kSmall, share);
}

template FigureInterval interval_of(const NoisyDraws<SpanValues>& draws);
template FigureInterval interval_of(const NoisyDraws<PeakValues>& draws);
template FigureInterval interval_of(const NoisyDraws<NormValues>& draws);

}  // namespace volcomp::host
