#pragma once
// How often intervals hold the truth and upper bounds are above it, over many campaigns.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/measure/intervals/interval.hpp"

namespace volcomp::test {

struct CoverageOptions {
  std::size_t campaigns = 1000;  // of a shape and size
  std::size_t draws = 1000;
  std::size_t first_size = 0;  // of kSizes, and so many of them from there on
  std::size_t sizes = SIZE_MAX;
  std::size_t whole_campaigns = 200;  // of a whole machine
  std::uint64_t seed = 1;

  [[nodiscard]] std::size_t last_size(std::size_t all) const {
    return first_size + std::min(sizes, all - first_size);
  }
};

// Of one campaign and figure.
struct Held {
  bool interval = false;
  bool bound = false;
};

inline Held held_by(const host::FigureInterval& found, double truth) {
  constexpr double kRounding = 1e-9;
  return {found.low <= truth + kRounding && truth <= found.high + kRounding,
          truth <= found.upper95 + kRounding};
}

// Noise of a campaign: readings are counted, so that no order of computing matters.
class Noise {
 public:
  Noise(std::uint64_t seed, std::size_t campaign)
      : seed_(seed + (std::uint64_t{1} << 40U)), campaign_(static_cast<std::uint32_t>(campaign)) {}

  double operator()(std::size_t set_up, std::size_t reading) const {
    constexpr auto kStream = static_cast<std::uint32_t>(RandomStream::repeatability);
    return normal(seed_, {kStream, campaign_, static_cast<std::uint32_t>(set_up),
                          static_cast<std::uint32_t>(reading)});
  }

 private:
  std::uint64_t seed_;
  std::uint32_t campaign_;
};

// The least share of `of` that chance may show of a true one, by 3.5 standard deviations.
inline bool enough(std::size_t held, std::size_t of, double least_percent) {
  const double n = static_cast<double>(of);
  const double p = least_percent / 100.0;
  return static_cast<double>(held) / n >= p - 3.5 * std::sqrt(p * (1.0 - p) / n);
}

// What an interval of 95 % should hold that is no extreme's.
inline constexpr double kLeastOfStated = 93.0;
inline constexpr double kMostOfStated = 97.0;

// Of one figure in several cells: what is measured, how large, with which noise.
class Shares {
 public:
  void add(const std::string& cell, std::size_t held, std::size_t of) {
    const double percent = 100.0 * static_cast<double>(held) / static_cast<double>(of);
    if (percent < least_) {
      least_ = percent;
      worst_ = {cell, held, of};
    }
    most_ = std::max(most_, percent);
    held_ += held;
    of_ += of;
  }

  void add(const Shares& other) {
    if (other.least_ < least_) {
      least_ = other.least_;
      worst_ = other.worst_;
    }
    most_ = std::max(most_, other.most_);
    held_ += other.held_;
    of_ += other.of_;
  }

  // The worst cell, and all together. Complains where they are not.
  [[nodiscard]] bool enough_of(double least_percent, const std::string& what) const {
    const bool good =
        enough(worst_.held, worst_.of, least_percent) && enough(held_, of_, least_percent);
    if (!good)
      fmt::print(stderr, "{}: held {:.1f} % ({}), together {:.1f} %; {} wanted\n", what, least_,
                 worst_.name, all(), least_percent);
    return good;
  }
  // And not more than 97 % together: an interval of 95 % that is wider than it need be.
  [[nodiscard]] bool as_stated(const std::string& what) const {
    const bool narrow = enough(of_ - held_, of_, 100.0 - kMostOfStated);
    if (!narrow) fmt::print(stderr, "{}: held {:.1f} % together\n", what, all());
    return enough_of(kLeastOfStated, what) && narrow;
  }
  // Each cell alone, and all together as if they were one cell of `campaigns`: for cells that go
  // together, as places of one function do. Complains where they are not from 93 to 97 %.
  [[nodiscard]] bool each_as_stated(std::size_t campaigns, const std::string& what) const {
    const auto within = [campaigns](double percent) {
      const auto held =
          static_cast<std::size_t>(std::lround(percent / 100.0 * static_cast<double>(campaigns)));
      return enough(held, campaigns, kLeastOfStated) &&
             enough(campaigns - held, campaigns, 100.0 - kMostOfStated);
    };
    const bool good = within(least_) && within(most_) && within(all());
    if (!good)
      fmt::print(stderr, "{}: held {} %; {} to {} wanted\n", what, text(), kLeastOfStated,
                 kMostOfStated);
    return good;
  }
  // "93.5 … 97.0 (95.2)": together.
  [[nodiscard]] std::string text() const {
    return fmt::format("{:.1f} … {:.1f} ({:.1f})", least_, most_, all());
  }
  [[nodiscard]] double least() const { return least_; }

 private:
  struct Cell {
    std::string name;
    std::size_t held = 0;
    std::size_t of = 0;
  };
  [[nodiscard]] double all() const {
    return 100.0 * static_cast<double>(held_) / static_cast<double>(of_);
  }

  double least_ = 101.0;
  double most_ = 0.0;
  Cell worst_;
  std::size_t held_ = 0;
  std::size_t of_ = 0;
};

// Intervals and upper bounds of one figure.
struct Coverage {
  Shares interval;
  Shares bound;
};

// `one(k)`: what the figures of campaign k hold, in the order of `out`.
template <class One>
void count_held(const std::string& cell, std::size_t campaigns, const One& one,
                std::vector<Coverage>& out) {
  std::vector<std::vector<Held>> held(campaigns);
  host::in_parallel(campaigns, host::processors(), [&](std::size_t k) { held[k] = one(k); });
  for (std::size_t f = 0; f < out.size(); ++f) {
    const auto count = [&](bool Held::*what) {
      return static_cast<std::size_t>(
          std::count_if(held.begin(), held.end(), [&](const auto& of) { return of[f].*what; }));
    };
    out[f].interval.add(cell, count(&Held::interval), campaigns);
    out[f].bound.add(cell, count(&Held::bound), campaigns);
  }
}

}  // namespace volcomp::test
