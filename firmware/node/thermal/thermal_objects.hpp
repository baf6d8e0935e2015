#pragma once
// The values behind 1012h and 2700h (temperatures, expansion of the axes, date), with their
// defaults.

#include <array>
#include <cstdint>

#include "comp/tick/temperature_input.hpp"
#include "firmware/canopen/object_lines.hpp"

namespace volcomp::node {

// 2703h:01.
enum class ThermalState : std::uint8_t {
  off = 0,        // no active tables whose axes grow
  following = 1,  // the active tables are those of the temperatures in use
  behind = 2,     // a temperature is on its way into the tables
  held = 3,       // the image buffer holds other tables: the axes keep their length until some are
                  // activated
};

struct ThermalObjects {
#define THERMAL OBJECT_MEMBER
#include "firmware/node/objects.def"

  // --- not on the bus
  Temperatures believed = kUnknownTemperatures;  // of the inputs: what tables are folded for
  std::uint32_t inputs = 0;                      // that the active tables use, a bit each
};

// Stands in for the objects in a node that follows no temperatures.
struct NoThermalObjects {};

}  // namespace volcomp::node
