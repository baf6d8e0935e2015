#include "firmware/node/thermal/thermal_service.hpp"

#include <algorithm>

#include "firmware/node/object_handles.hpp"

namespace volcomp::node {

namespace {

constexpr std::uint64_t kPeriod_us = 500'000;

constexpr std::uint32_t kDaysTo1984 = 5113;  // since 1 January 1970
constexpr std::uint32_t kSecondsPerDay = 86'400;

// Of two times that may wrap around.
std::uint32_t distance_s(std::uint32_t a, std::uint32_t b) { return std::min(a - b, b - a); }

}  // namespace

void ThermalService::arrived(canopen::ObjectId object) {
  if (object.index == object::thermal::reading.index) {
    const std::size_t input = object.sub - 1U;
    inputs_[input].take(objects_.reading[input], now_s_);
  }
  if (object.index == object::thermal::unix_s.index) set_clock(objects_.unix_s);
}

bool ThermalService::time_of_day(std::uint32_t midnight_ms, std::uint16_t days_1984) {
  const std::uint32_t told_s = (kDaysTo1984 + days_1984) * kSecondsPerDay + midnight_ms / 1000U;
  const std::uint32_t start_s = told_s - now_s_;
  const bool goes_on = doubted_ != 0 && distance_s(start_s, doubted_start_s_) <= kMostLate_s;
  doubted_ = static_cast<std::uint8_t>(goes_on ? doubted_ + 1 : 1);
  doubted_start_s_ = start_s;
  const bool near = distance_s(start_s, clock_s_ - told_at_s_) <= kMostJump_s;
  const bool believed = clock_s_ == 0 || near || doubted_ >= kConfirmed;
  if (believed) set_clock(told_s);
  return believed;
}

bool ThermalService::poll(std::uint64_t now_us) {
  if (now_us < next_us_) return false;
  next_us_ = now_us + kPeriod_us;
  now_s_ = static_cast<std::uint32_t>(now_us / 1'000'000U);
  for (std::size_t i = 0; i < kTemperatureInputs; ++i)
    objects_.input[i] = static_cast<std::uint8_t>(inputs_[i].state(now_s_, objects_.stale_s));
  objects_.believed = temperatures_of(inputs_);
  objects_.unix_s = clock_s_ == 0 ? 0 : clock_s_ + (now_s_ - told_at_s_);
  return true;
}

}  // namespace volcomp::node
