#pragma once
// Temperatures and date of the node (2700h), and the active tables that follow them.

#include <type_traits>

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/tables/table_download.hpp"
#include "firmware/node/thermal/thermal_service.hpp"

namespace volcomp::node {

class FollowedTemperatures : public NodePart {
 public:
  FollowedTemperatures(NodeCore& core, TableDownload& tables);

  void reset() { service_.reset(); }
  void arrived(std::uint32_t bits);
  void written(canopen::ObjectId object) { service_.arrived(object); }
  // Twice a second: temperatures, expiry, and tables folded again when they are behind.
  void background(std::uint64_t now_us);
  void time_of_day(std::uint32_t midnight_ms, std::uint16_t days);

 private:
  ThermalState follow();
  void complain_if(bool wrong, canopen::ErrorCode code, std::uint8_t source, std::uint8_t detail);

  NodeCore& core_;
  TableDownload& tables_;
  ThermalService service_;
};

// A node that follows no temperatures.
struct NoTemperatures : NodePart {
  NoTemperatures(NodeCore& /*core*/, TableDownload& /*tables*/) {}
  static void time_of_day(std::uint32_t /*midnight_ms*/, std::uint16_t /*days*/) {}
};

using ThermalPart = std::conditional_t<kFollowsTemperature, FollowedTemperatures, NoTemperatures>;

}  // namespace volcomp::node
