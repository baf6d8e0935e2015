#include "firmware/node/thermal/thermal_part.hpp"

#include <algorithm>

#include "firmware/node/object_handles.hpp"
#include "firmware/node/thermal/table_growth.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

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

FollowedTemperatures::FollowedTemperatures(NodeCore& core, TableDownload& tables)
    : core_(core), tables_(tables), service_(core.objects.thermal) {}

void FollowedTemperatures::arrived(std::uint32_t bits) {
  for (std::size_t i = 0; i < kTemperatureInputs; ++i) {
    if ((bits & bit(Arrival::kTemperature + i)) != 0)
      service_.arrived(object::thermal::reading[i].id());
  }
}

void FollowedTemperatures::time_of_day(std::uint32_t midnight_ms, std::uint16_t days) {
  complain_if(!service_.time_of_day(midnight_ms, days), ErrorCode::time_doubted, 0, 0);
}

// The same image again, as warm as the machine is now: handed over like new tables, so the ramp
// hides the step, and the next one waits until that is over.
ThermalState FollowedTemperatures::follow() {
  ThermalObjects& t = core_.objects.thermal;
  if (core_.objects.active_crc == 0 || t.inputs == 0) return ThermalState::off;
  if (tables_.state() != TableState::active) return ThermalState::held;
  const Strains now = strains_now(tables_.checked(), core_.objects);
  t.behind_nm = static_cast<std::uint32_t>(largest_growth_nm(tables_.checked(), now));
  if (t.behind_nm < t.threshold_nm) return ThermalState::following;
  if (core_.running && !core_.compensator.at_rest()) return ThermalState::behind;
  if (!tables_.fold_again(now)) return ThermalState::held;
  if (t.followed < UINT32_MAX) ++t.followed;
  t.behind_nm = 0;
  return ThermalState::following;
}

void FollowedTemperatures::background(std::uint64_t now_us) {
  if (!service_.poll(now_us)) return;
  ThermalObjects& t = core_.objects.thermal;
  t.state = static_cast<std::uint8_t>(follow());
  const bool active = core_.objects.active_crc != 0;
  const bool past = active && expired(t.expires_unix_s, t.unix_s);
  t.expired = past ? 1 : 0;
  complain_if(past, ErrorCode::tables_expired, 0, 0);
  for (std::uint8_t i = 0; i < kTemperatureInputs; ++i) {
    const bool used = active && (t.inputs >> i & 1U) != 0;
    const bool held = t.input[i] > static_cast<std::uint8_t>(TemperatureState::good);
    complain_if(held && used, ErrorCode::temperature_held, static_cast<std::uint8_t>(i + 1),
                t.input[i]);
  }
}

void FollowedTemperatures::complain_if(bool wrong, ErrorCode code, std::uint8_t source,
                                       std::uint8_t detail) {
  if (wrong) return core_.emergency().raise(code, source, {detail});
  core_.emergency().clear(code, source);
}

}  // namespace volcomp::node
