#pragma once
// What others compute per axis, beside which the tick is measured: textbook versions written here
// from the published descriptions, no code of theirs.

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "comp/core/units.hpp"
#include "tests/bench/machines.hpp"

namespace volcomp::bench {

// A one-channel table with its own positions, as a textbook has it: clamp, interval by division,
// interpolate.
struct LinearTable {
  float first = 0.0F;
  float pitch = 1.0F;
  int knots = 0;
  std::array<float, 128> value{};

  [[nodiscard]] float at(float q) const {
    const float last = first + pitch * static_cast<float>(knots - 1);
    if (q <= first) return value[0];
    if (q >= last) return value[static_cast<std::size_t>(knots - 1)];
    const float place = (q - first) / pitch;
    const int i = static_cast<int>(place);
    const float t = place - static_cast<float>(i);
    const auto k = static_cast<std::size_t>(i);
    return value[k] + t * (value[k + 1] - value[k]);
  }
};

// The same by the formula of arm_linear_interp_f32 (CMSIS-DSP, group "Linear Interpolation":
// y = y0 + (x - x0) (y1 - y0) / (x1 - x0)): the interval is found by a division, its ends are
// formed again and the slope is a second division.
struct DspTable : LinearTable {
  [[nodiscard]] float at(float q) const {
    const int i = static_cast<int>((q - first) / pitch);
    if (i < 0) return value[0];
    if (i >= knots - 1) return value[static_cast<std::size_t>(knots - 1)];
    const auto k = static_cast<std::size_t>(i);
    const float here = first + static_cast<float>(i) * pitch;
    const float next = first + static_cast<float>(i + 1) * pitch;
    return value[k] + (q - here) * ((value[k + 1] - value[k]) / (next - here));
  }
};

// Leadscrew compensation as LinuxCNC documents it (COMP_FILE of an axis, "Backlash Compensation" in
// its integrator's manual; src/emc/motion/control.c, compute_screw_comp): a table of its own
// positions for one axis, walked to the interval of the last period on, by direction a trim and a
// slope; the correction follows with limited speed and acceleration.
class ScrewCompensation {
 public:
  struct Entry {
    double position = 0.0;  // mm
    std::array<double, 2> trim{};
    std::array<double, 2> slope{};  // to the next entry
  };
  // `entries`: at least two, all positions between the first and the last.
  explicit ScrewCompensation(std::vector<Entry> entries)
      : entries_(std::move(entries)), at_(entries_.data()) {}

  ScrewCompensation(ScrewCompensation&&) = default;  // the vector keeps its place
  ScrewCompensation(const ScrewCompensation&) = delete;
  ScrewCompensation& operator=(const ScrewCompensation&) = delete;
  ~ScrewCompensation() = default;

  double step(double q) {
    while (q < at_->position)
      --at_;
    while (q >= at_[1].position)
      ++at_;
    const bool moves = q > last_ || q < last_;
    if (moves) {
      const std::size_t way = q > last_ ? 0 : 1;
      wanted_ = at_->trim[way] + at_->slope[way] * (q - at_->position);
    }
    last_ = q;
    follow();
    return applied_;
  }

 private:
  static constexpr double kPeriod = 0.001;        // s
  static constexpr double kSpeed = 10.0;          // mm/s
  static constexpr double kAcceleration = 500.0;  // mm/s²

  // Towards the wanted correction: brakes when the way left is what stopping takes.
  void follow() {
    const double left = wanted_ - applied_;
    const double side = left < 0.0 ? -1.0 : 1.0;
    const double way = side * left;
    if (way <= 0.0) return;
    constexpr double kGain = kAcceleration * kPeriod;  // of speed in a period
    const double faster = speed_ + kGain;
    const bool brakes = way <= 0.5 * faster * faster / kAcceleration + speed_ * kPeriod;
    if (brakes && speed_ <= kGain) {
      speed_ = 0.0;
      applied_ = wanted_;
      return;
    }
    const double next = brakes ? speed_ - kGain : (faster < kSpeed ? faster : kSpeed);
    applied_ += side * 0.5 * (speed_ + next) * kPeriod;
    speed_ = next;
  }

  std::vector<Entry> entries_;
  const Entry* at_;
  double last_ = 0.0;
  double wanted_ = 0.0;
  double applied_ = 0.0;
  double speed_ = 0.0;
};

// Six tables of one kind for each of three axes, of the same values as the tick has.
template <class Table>
using TablesOf = std::array<std::array<Table, 6>, 3>;

template <class Table = LinearTable>
std::unique_ptr<TablesOf<Table>> channel_tables() {
  const auto tables = make_tables(kGeneric);
  auto out = std::make_unique<TablesOf<Table>>();
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisTable& from = tables->axis[a];
    for (std::size_t c = 0; c < 6; ++c) {
      Table& to = (*out)[a][c];
      to.first = static_cast<float>(static_cast<double>(from.q0) / kNmPerMm);
      to.pitch = static_cast<float>(static_cast<double>(from.pitch) / kNmPerMm);
      to.knots = static_cast<int>(from.knots);
      for (std::size_t i = 0; i < from.knots; ++i)
        to.value[i] = from.value[0][i][c];
    }
  }
  return out;
}

// Of three axes.
template <class Table>
std::array<float, 18> eighteen_lookups(const TablesOf<Table>& tables,
                                       const std::array<float, 3>& q) {
  std::array<float, 18> value{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t c = 0; c < 6; ++c)
      value[6 * a + c] = tables[a][c].at(q[a]);
  }
  return value;
}

}  // namespace volcomp::bench
