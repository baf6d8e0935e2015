#pragma once
// The object dictionary of the compensation node for configuration tools: read from the tables of
// the code and from nodes that have just been powered on.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/canopen/object_dictionary.hpp"

namespace volcomp::host {

// CiA 301, table 42.
enum class ObjectCode : std::uint8_t { domain = 0x02, var = 0x07, array = 0x08, record = 0x09 };

struct EdsValue {
  std::uint8_t sub = 0;
  std::string name;
  canopen::DataType type = canopen::DataType::unsigned8;
  std::string access;  // ro, const, rw, rww (RPDO), rwr (TPDO): CiA 306-1, section 4.6.3
  bool mappable = false;
  std::optional<std::int64_t> low;  // inclusive
  std::optional<std::int64_t> high;
  std::optional<std::string> value;  // after power-on; none: nothing to read then
};

struct EdsObject {
  std::uint16_t index = 0;
  std::string name;
  ObjectCode code = ObjectCode::var;
  std::vector<EdsValue> values;  // one of a VAR, otherwise by sub-index
};

// Every object of the node, by index.
[[nodiscard]] std::vector<EdsObject> node_eds_objects();

}  // namespace volcomp::host
