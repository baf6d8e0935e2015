#pragma once
// Statistics of a signal that is never stored: O(1) per sample. Sums are doubles, for the mean of a
// lag is 500 times its spread; no call into the C library in any add(). Seed 003 section 8.

#include <cmath>
#include <cstdint>

namespace volcomp {

class RunningStatistics {
 public:
  // Welford. A sample that is not finite is counted and changes nothing else; then false.
  // Interrupt-safe.
  bool add(double value) {
    const double magnitude = value < 0.0 ? -value : value;
    if (!(magnitude <= kMost)) {
      ++bad_;
      return false;
    }
    ++n_;
    const double off = value - mean_;
    mean_ += off / static_cast<double>(n_);
    squares_ += off * (value - mean_);
    if (magnitude > peak_) peak_ = magnitude;
    return true;
  }

  [[nodiscard]] std::uint32_t count() const { return n_; }
  [[nodiscard]] std::uint32_t bad() const { return bad_; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double peak() const { return peak_; }
  // Of the population: divided by n. 0 without samples.
  [[nodiscard]] double variance() const {
    return n_ == 0 ? 0.0 : squares_ / static_cast<double>(n_);
  }
  [[nodiscard]] double deviation() const { return std::sqrt(variance()); }
  [[nodiscard]] double rms() const { return std::sqrt(variance() + mean_ * mean_); }

 private:
  static constexpr double kMost = 1e300;  // what lies beyond is not a measurement

  std::uint32_t n_ = 0;
  std::uint32_t bad_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
  double peak_ = 0.0;
};

// c = 2/n Σ (v − mean) e^(−iθ): amplitude and phase of a part that repeats with the angle θ.
struct SpectralLine {
  double amplitude = 0.0;
  double phase = 0.0;  // rad, of cos(θ + phase)
};

// A line in order: the angle belongs to a position (2π z / λ, a turn of C, a slot), so it may come
// in any order and with gaps.
class OrderLine {
 public:
  // Interrupt-safe.
  void add(double value, double cosine, double sine) {
    ++n_;
    sum_ += value;
    cosines_ += cosine;
    sines_ += sine;
    with_cosine_ += value * cosine;
    with_sine_ += value * sine;
  }

  [[nodiscard]] std::uint32_t count() const { return n_; }
  [[nodiscard]] SpectralLine line() const {
    if (n_ == 0) return {};
    const auto n = static_cast<double>(n_);
    const double mean = sum_ / n;
    const double re = 2.0 / n * (with_cosine_ - mean * cosines_);
    const double im = -2.0 / n * (with_sine_ - mean * sines_);
    return {std::hypot(re, im), std::atan2(im, re)};
  }

 private:
  std::uint32_t n_ = 0;
  double sum_ = 0.0;
  double cosines_ = 0.0;
  double sines_ = 0.0;
  double with_cosine_ = 0.0;
  double with_sine_ = 0.0;
};

// A line in time, by Goertzel's recursion: one multiplication per sample, samples equally spaced.
class TimeLine {
 public:
  TimeLine() = default;
  // `turns_per_sample`: frequency over sampling rate, 0…0.5, ends excluded. Background.
  explicit TimeLine(double turns_per_sample);

  // Interrupt-safe.
  void add(double value) {
    const double s = value + twice_cosine_ * last_ - before_;
    before_ = last_;
    last_ = s;
    sum_ += value;
    ++n_;
  }

  [[nodiscard]] std::uint32_t count() const { return n_; }
  // The mean is taken out. The phase is that of the first sample.
  [[nodiscard]] SpectralLine line() const;

  // As before the first sample.
  void restart() {
    n_ = 0;
    last_ = before_ = sum_ = 0.0;
  }

 private:
  double angle_ = 0.0;  // per sample, rad
  double twice_cosine_ = 2.0;
  double last_ = 0.0;
  double before_ = 0.0;
  double sum_ = 0.0;
  std::uint32_t n_ = 0;
};

}  // namespace volcomp
