#pragma once
// The rows of the object dictionary behind ThermalObjects.

#include <cstddef>

#include "firmware/node/row_lists.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"

namespace volcomp::node {

namespace detail {

#define VOLCOMP_AT(member) static_cast<std::uint16_t>(offsetof(ThermalObjects, member))

inline constexpr std::array<canopen::NamedEntry, 1> kTimeRows{
    {{0x1012, 0, 0, canopen::DataType::unsigned32, canopen::Access::read_only, canopen::kPlain,
      VOLCOMP_AT(time_cob_id), 0, "COB-ID TIME"}}};

inline constexpr std::array<canopen::NamedEntry, 10> kThermalRows{{
    {kTemperatureObject, 1, kTemperatureInputs, canopen::DataType::integer16,
     canopen::Access::read_write, canopen::kReceive, VOLCOMP_AT(reading), 0,
     "Temperature, 0.01 deg C; -32768: none"},
    {0x2701, 1, kTemperatureInputs, canopen::DataType::unsigned8, canopen::Access::read_only,
     canopen::kTransmit, VOLCOMP_AT(input), 0, "Input: 0 unknown, 1 good, 2 stale, 3 implausible"},
    {0x2702, 1, 1, canopen::DataType::unsigned32, canopen::Access::read_write, canopen::kStored,
     VOLCOMP_AT(threshold_nm), 0, "Tables follow from this change on, nm", 1, 1000000},
    {0x2702, 2, 2, canopen::DataType::unsigned16, canopen::Access::read_write, canopen::kStored,
     VOLCOMP_AT(stale_s), 0, "A temperature is stale after, s", 1, 3600},
    {0x2703, 1, 1, canopen::DataType::unsigned8, canopen::Access::read_only, canopen::kTransmit,
     VOLCOMP_AT(state), 0, "Expansion: 0 none, 1 follows, 2 behind, 3 held"},
    {0x2703, 2, 2, canopen::DataType::unsigned32, canopen::Access::read_only, canopen::kPlain,
     VOLCOMP_AT(behind_nm), 0, "Largest growth not yet in the tables, nm"},
    {0x2703, 3, 3, canopen::DataType::unsigned32, canopen::Access::read_only, canopen::kPlain,
     VOLCOMP_AT(followed), 0, "Times the tables followed a temperature"},
    {kClockObject, 1, 1, canopen::DataType::unsigned32, canopen::Access::read_write,
     canopen::kPlain, VOLCOMP_AT(unix_s), 0, "Time, s since 1970; 0: not known"},
    {kClockObject, 2, 2, canopen::DataType::unsigned32, canopen::Access::read_only, canopen::kPlain,
     VOLCOMP_AT(expires_unix_s), 0, "Active tables expire, s since 1970; 0: never"},
    {kClockObject, 3, 3, canopen::DataType::unsigned8, canopen::Access::read_only,
     canopen::kTransmit, VOLCOMP_AT(expired), 0, "Active tables are past their expiry"},
}};

#undef VOLCOMP_AT

}  // namespace detail

// Rows of a ThermalObjects at `offset` of the node's values; sorted. Empty where there is none.
template <bool there>
constexpr auto time_rows(std::size_t offset) {
  if constexpr (there)
    return detail::moved_by(offset, detail::kTimeRows);
  else
    return std::array<canopen::NamedEntry, 0>{};
}

template <bool there>
constexpr auto thermal_rows(std::size_t offset) {
  if constexpr (there)
    return detail::moved_by(offset, detail::kThermalRows);
  else
    return std::array<canopen::NamedEntry, 0>{};
}

}  // namespace volcomp::node
