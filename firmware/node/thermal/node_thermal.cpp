// Temperatures and date of the node, and tables that follow them.

#include <algorithm>

#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

namespace {

constexpr std::uint64_t kPeriod_us = 500'000;

constexpr std::uint32_t kDaysTo1984 = 5113;  // since 1 January 1970
constexpr std::uint32_t kSecondsPerDay = 86'400;

}  // namespace

void ThermalService::arrived(canopen::ObjectId object) {
  if (object.index == kTemperatureObject) {
    const std::size_t input = object.sub - 1U;
    inputs_[input].take(objects_.reading[input], now_s_);
  }
  if (object.index == kClockObject) set_clock(objects_.unix_s);
}

void ThermalService::time_of_day(std::uint32_t midnight_ms, std::uint16_t days_1984) {
  set_clock((kDaysTo1984 + days_1984) * kSecondsPerDay + midnight_ms / 1000U);
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

// --- tables

bool TableDownload::past_expiry() const {
  return expired(tables_.provenance.expires_unix_s, objects_.thermal.unix_s);
}

// Before tables are folded.
void TableDownload::grow() { tables_.strain = strains(tables_, objects_.thermal.believed); }

// What the active tables say of expansion and expiry.
void TableDownload::note_growth() {
  ThermalObjects& t = objects_.thermal;
  // The wire has 32 bits, enough until 2106.
  t.expires_unix_s = static_cast<std::uint32_t>(
      std::min<std::int64_t>(tables_.provenance.expires_unix_s, UINT32_MAX));
  t.inputs = 0;
  for (const AxisExpansion& e : tables_.expansion) {
    const bool grows = e.per_K < 0.0F || e.per_K > 0.0F;
    if (grows && e.input < kTemperatureInputs) t.inputs |= 1U << e.input;
  }
}

// The same image again, as warm as the machine is now: handed over like new tables, so the ramp
// hides the step, and the next one waits until that is over.
ThermalState TableDownload::follow() {
  ThermalObjects& t = objects_.thermal;
  if (objects_.active_crc == 0 || t.inputs == 0) return ThermalState::off;
  if (state() != TableState::active) return ThermalState::held;
  const Strains folded = tables_.strain;
  t.behind_nm =
      static_cast<std::uint32_t>(largest_growth_nm(tables_, strains(tables_, t.believed)));
  if (t.behind_nm < t.threshold_nm) return ThermalState::following;
  if (running_ && !compensator_.at_rest()) return ThermalState::behind;
  grow();
  const std::uint32_t crc = name_of({image_.data(), objects_.staged_bytes});
  const bool staged = crc == objects_.active_crc && stage(compensator_.machine().chain).ok();
  // The tick may have dropped the tables meanwhile.
  if (!staged || state() != TableState::active) {
    tables_.strain = folded;
    return ThermalState::held;
  }
  static_cast<void>(compensator_.activate());
  settle();
  if (t.followed < UINT32_MAX) ++t.followed;
  t.behind_nm = 0;
  return ThermalState::following;
}

// --- node

void Node::poll_thermal(std::uint64_t now_us) {
  if (!thermal_.poll(now_us)) return;
  ThermalObjects& t = objects_.thermal;
  t.state = static_cast<std::uint8_t>(download_.follow());
  const bool active = objects_.active_crc != 0;
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

void Node::complain_if(bool wrong, ErrorCode code, std::uint8_t source, std::uint8_t detail) {
  if (wrong) return device_.emergency().raise(code, source, {detail});
  device_.emergency().clear(code, source);
}

}  // namespace volcomp::node
