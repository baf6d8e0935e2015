#pragma once
// Statistics of a signal that is never stored: O(1) per sample. Sums are doubles, for the mean of a
// lag is 500 times its spread; no call into the C library in any add().

#include <cmath>
#include <cstdint>

#include "comp/machine/fine_trig.hpp"

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

  // As if all samples had come here.
  void merge(const RunningStatistics& other) {
    bad_ += other.bad_;
    if (other.n_ == 0) return;
    const auto mine = static_cast<double>(n_);
    const auto more = static_cast<double>(other.n_);
    const double off = other.mean_ - mean_;
    mean_ += off * more / (mine + more);
    squares_ += other.squares_ + off * off * mine * more / (mine + more);
    if (other.peak_ > peak_) peak_ = other.peak_;
    n_ += other.n_;
  }

  [[nodiscard]] std::uint32_t count() const { return n_; }
  [[nodiscard]] std::uint32_t bad() const { return bad_; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double peak() const { return peak_; }
  // Variance of the population: divided by n. 0 without samples.
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

// A line of the spectrum is c = 2/n Σ (v − mean) e^(−iθ): what a signal repeats with an angle θ.
// The two classes only sum; comp/strokes/spectral_line.hpp makes amplitude and phase of the
// sums.

// A line in order: the angle belongs to a position (2π z / λ, a turn of C, a slot), so it may come
// in any order and with gaps.
struct OrderLine {
  std::uint32_t n = 0;
  double sum = 0.0;
  double cosines = 0.0;
  double sines = 0.0;
  double with_cosine = 0.0;
  double with_sine = 0.0;

  // Interrupt-safe.
  void add(double value, double cosine, double sine) {
    ++n;
    sum += value;
    cosines += cosine;
    sines += sine;
    with_cosine += value * cosine;
    with_sine += value * sine;
  }

  // As if all samples had come here.
  void merge(const OrderLine& other) {
    n += other.n;
    sum += other.sum;
    cosines += other.cosines;
    sines += other.sines;
    with_cosine += other.with_cosine;
    with_sine += other.with_sine;
  }
};

// A line in time, by Goertzel's recursion: one multiplication per sample, samples equally spaced.
struct TimeLine {
  double angle = 0.0;  // per sample, rad; 0: the line is not used
  double twice_cosine = 2.0;
  double last = 0.0;
  double before = 0.0;
  double sum = 0.0;
  std::uint32_t n = 0;

  // Interrupt-safe.
  void add(double value) {
    const double s = value + twice_cosine * last - before;
    before = last;
    last = s;
    sum += value;
    ++n;
  }
};

// `turns_per_sample`: frequency over sampling rate, 0…0.5, ends excluded. Not the cosine of the C
// library: what a tick computes with it has the same bits everywhere.
inline TimeLine time_line(double turns_per_sample) {
  TimeLine line;
  line.angle = 2.0 * kPi * turns_per_sample;
  line.twice_cosine =
      2.0 * fine_sine_cosine(turns_per_sample * static_cast<double>(kUnitsPerTurn)).cosine;
  return line;
}

}  // namespace volcomp
