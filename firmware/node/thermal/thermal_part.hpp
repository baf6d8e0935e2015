#pragma once
// Temperatures and date of the node (2700h), and the active tables that follow them.

#include <type_traits>

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/tables/table_download.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"

namespace volcomp::node {

// Turns readings into the assumed temperatures of the axes and TIME into seconds since 1970.
class ThermalService {
 public:
  explicit ThermalService(ThermalObjects& objects) : objects_(objects) {}

  void reset() {
    inputs_ = {};
    clock_s_ = 0;
    doubted_ = 0;
  }

  // An object of the node was written, by a PDO or over SDO.
  void arrived(canopen::ObjectId object);
  // CANopen TIME, which any node on the bus can send. The first one is accepted; a later one that
  // is more than kMostJump_s off the clock is rejected (false), unless it is the kConfirmed-th in a
  // row and each continues the one before.
  [[nodiscard]] bool time_of_day(std::uint32_t midnight_ms, std::uint16_t days_1984);
  // More than the hour by which producers of local time jump twice a year and what a crystal drifts
  // in a year (100 ppm: 53 min); less than a day, in which expiries are given.
  static constexpr std::uint32_t kMostJump_s = 7200;
  static constexpr std::uint8_t kConfirmed = 3;
  // Allowed lag of TIME, because the clock is read twice a second.
  static constexpr std::uint32_t kMostLate_s = 2;

  // Twice a second: updates 2701h, 2704h:01 and the assumed temperatures. False: it is not time
  // yet.
  bool poll(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t rests_until_us() const { return next_us_; }

 private:
  void set_clock(std::uint32_t unix_s) {
    clock_s_ = objects_.unix_s = unix_s;
    told_at_s_ = now_s_;
    doubted_ = 0;
  }

  ThermalObjects& objects_;
  TemperatureInputs inputs_{};
  std::uint64_t next_us_ = 0;
  std::uint32_t now_s_ = 0;      // since the start
  std::uint32_t clock_s_ = 0;    // since 1970, at the last TIME; 0: never
  std::uint32_t told_at_s_ = 0;  // since the start
  // The latest rejected TIME less the time since the start, and how many agree.
  std::uint32_t doubted_start_s_ = 0;
  std::uint8_t doubted_ = 0;
};

class FollowedTemperatures : public NodePart {
 public:
  FollowedTemperatures(NodeCore& core, TableDownload& tables);

  void reset() { service_.reset(); }
  void arrived(std::uint32_t bits);
  void written(canopen::ObjectId object) { service_.arrived(object); }
  // Twice a second: temperatures, expiry, and tables folded again when they are behind.
  void background(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t rests_until_us() const { return service_.rests_until_us(); }
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
