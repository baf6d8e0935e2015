#pragma once
// The settings under which the most expensive tick is looked for.

#include <array>
#include <cstdint>

#include "comp/tick/tick_types.hpp"
#include "tests/target/ticks/axis_faults.hpp"
#include "tests/target/ticks/draw.hpp"

namespace volcomp::target {

enum class Accelerations : std::uint8_t { none, limited };

template <std::size_t Axes>
class AdverseSettings {
 public:
  using Settings = CompensatorSettings<Axes>;
  using Rooms = std::array<AxisRoom, Axes>;

  static constexpr std::uint32_t kPlans = 3 * 3 * 2 * 2 * 2 * 2;

  explicit AdverseSettings(std::size_t axes) : axes_(axes) {}

  void limit(Accelerations accelerations) { accelerations_ = accelerations; }
  [[nodiscard]] const Settings& get() const { return settings_; }

  // By chance. `faults`: steps may be implausible.
  void draw(Draw& draw, const Rooms& rooms, bool faults) {
    constexpr std::array<std::int32_t, 6> kLimits{1, 300, 2'000, 6'000, 20'000, kMostLimit};
    constexpr std::array<std::int32_t, 5> kRates{1, 50, 500, 2'000, kMostRate};
    constexpr std::array<std::int32_t, 5> kAccelerations{1, 7, 100, 1'000, 10'000};
    const Pace all{draw.one_of(kLimits), draw.one_of(kRates), draw.one_of(kAccelerations)};
    const bool unlimited = draw.once_in(4);
    const bool mixed = draw.once_in(3);
    for (std::size_t a = 0; a < axes_; ++a) {
      Pace pace = all;
      if (mixed && draw.once_in(2)) pace.limit = draw.one_of(kLimits);
      if (mixed && draw.once_in(2)) pace.rate = draw.one_of(kRates);
      if (unlimited) pace = kUnlimited;
      set(a, pace, draw.once_in(2) ? 1 : 100);
      settings_.axis[a].hysteresis = draw.once_in(2) ? 0 : 2'000;
      settings_.axis[a].max_step = faults && draw.once_in(2) ? 8 * rooms[a].unit : 0;
    }
    settings_.ramp_ticks = draw.once_in(4) ? 1 : 1 + draw.below(100);
    settings_.stale_drop_ticks = static_cast<std::uint16_t>(draw.once_in(2) ? 0 : draw.below(4));
    settings_.source = draw.once_in(4) ? PositionSource::actual : PositionSource::target;
  }

  // By plan, 0…kPlans − 1: every combination.
  void plan(std::uint32_t number, const Rooms& rooms) {
    constexpr std::array<std::int32_t, 3> kLimits{1, 2'000, kMostLimit};
    constexpr std::array<std::int32_t, 3> kRates{1, 500, kMostRate};
    constexpr std::array<std::int32_t, 4> kAccelerations{1, 30, 900, 1 << 24};
    const std::int32_t acceleration = kAccelerations[number / 2 % kAccelerations.size()];
    const auto digit = [&number](std::uint32_t base) {
      const std::uint32_t value = number % base;
      number /= base;
      return value;
    };
    const std::int32_t limit = kLimits[digit(3)];
    const std::int32_t rate = kRates[digit(3)];
    const bool sticky = digit(2) != 0;
    const bool checked = digit(2) != 0;
    for (std::size_t a = 0; a < axes_; ++a) {
      set(a, {limit, rate, acceleration}, 1);
      settings_.axis[a].hysteresis = sticky ? kMostLimit : 0;
      settings_.axis[a].max_step = checked ? 8 * rooms[a].unit : 0;
    }
    settings_.stale_drop_ticks = digit(2) != 0 ? 0 : 9;
    settings_.ramp_ticks = digit(2) != 0 ? 1 : 8;
    settings_.source = PositionSource::target;
  }

  // Small steps, no ramp.
  void slow(std::int32_t limit, std::int32_t rate) {
    settings_.ramp_ticks = 1;
    for (std::size_t a = 0; a < axes_; ++a) {
      set(a, {limit, rate, 1}, 1);
      settings_.axis[a].hysteresis = 0;
      settings_.axis[a].max_step = 0;
    }
  }

  // A limit that nothing else in a compensator equals by chance.
  void mark(std::int32_t limit) { settings_.axis[0].limit = limit; }

 private:
  static constexpr std::int32_t kMostLimit = 4'194'303;
  static constexpr std::int32_t kMostRate = 1'000'000'000;

  struct Pace {
    std::int32_t limit, rate, acceleration;
  };
  static constexpr Pace kUnlimited{kMostLimit, kMostRate, 1 << 24};

  void set(std::size_t axis, const Pace& pace, std::int32_t soft_rate) {
    AxisLimits& limits = settings_.axis[axis];
    limits.limit = pace.limit;
    limits.rate = pace.rate;
    limits.soft_rate = soft_rate < pace.rate ? soft_rate : pace.rate;
    limits.acceleration = accelerations_ == Accelerations::limited ? pace.acceleration : 0;
  }

  std::size_t axes_;
  Accelerations accelerations_ = Accelerations::none;
  Settings settings_{};
};

}  // namespace volcomp::target
