#pragma once
// The values behind 1012h and 2700h (temperatures, expansion of the axes, date), with their
// defaults.

#include <array>
#include <cstdint>

#include "comp/tick/temperature_input.hpp"

namespace volcomp::node {

// 2703h:01.
enum class ThermalState : std::uint8_t {
  off = 0,        // no active tables whose axes grow
  following = 1,  // the active tables are those of the temperatures in use
  behind = 2,     // a temperature is on its way into the tables
  held = 3,       // the image buffer holds other tables: the axes keep their length until some are
                  // activated
};

inline constexpr std::uint16_t kTemperatureObject = 0x2700;
inline constexpr std::uint16_t kClockObject = 0x2704;

struct ThermalObjects {
  std::uint32_t time_cob_id = 0x8000'0100;  // 1012h; bit 31: consumes

  std::array<std::int16_t, kTemperatureInputs> reading{
      TemperatureInput::kNone, TemperatureInput::kNone, TemperatureInput::kNone,
      TemperatureInput::kNone};                          // 2700h 0.01 °C
  std::array<std::uint8_t, kTemperatureInputs> input{};  // 2701h TemperatureState
  std::uint32_t threshold_nm = 50;                       // 2702h:01
  std::uint16_t stale_s = 60;                            // 2702h:02
  std::uint8_t state = 0;                                // 2703h:01 ThermalState
  std::uint32_t behind_nm = 0;                           // 2703h:02
  std::uint32_t followed = 0;                            // 2703h:03
  std::uint32_t unix_s = 0;                              // 2704h:01 0: not known
  std::uint32_t expires_unix_s = 0;                      // 2704h:02 of the active tables
  std::uint8_t expired = 0;                              // 2704h:03

  // --- not on the bus
  Temperatures believed = kUnknownTemperatures;  // of the inputs: what tables are folded for
  std::uint32_t inputs = 0;                      // that the active tables use, a bit each
};

// Stands in for the objects in a node that follows no temperatures.
struct NoThermalObjects {};

}  // namespace volcomp::node
