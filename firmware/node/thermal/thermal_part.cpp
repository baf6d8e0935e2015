#include "firmware/node/thermal/thermal_part.hpp"

#include "firmware/node/thermal/table_growth.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

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
