#pragma once
// What the node knows of temperatures and of the date: readings become temperatures that axes are
// believed to have, TIME becomes seconds since 1970.

#include "firmware/canopen/object_access.hpp"
#include "firmware/node/thermal/thermal_objects.hpp"

namespace volcomp::node {

class ThermalService {
 public:
  explicit ThermalService(ThermalObjects& objects) : objects_(objects) {}

  void reset() {
    inputs_ = {};
    clock_s_ = 0;
  }

  // An object of the node was written, by a PDO or over SDO.
  void arrived(canopen::ObjectId object);
  // CANopen TIME.
  void time_of_day(std::uint32_t midnight_ms, std::uint16_t days_1984);

  // Twice a second: 2701h, 2704h:01 and what is believed as of now. False: it is not time yet.
  bool poll(std::uint64_t now_us);

 private:
  void set_clock(std::uint32_t unix_s) {
    clock_s_ = objects_.unix_s = unix_s;
    told_at_s_ = now_s_;
  }

  ThermalObjects& objects_;
  TemperatureInputs inputs_{};
  std::uint64_t next_us_ = 0;
  std::uint32_t now_s_ = 0;      // since the start
  std::uint32_t clock_s_ = 0;    // since 1970, when it was told; 0: never
  std::uint32_t told_at_s_ = 0;  // since the start
};

// Of a node that follows no temperatures.
struct NoThermalService {
  explicit NoThermalService(NoThermalObjects& /*objects*/) {}
  void reset() {}
  void arrived(canopen::ObjectId /*object*/) {}
  void time_of_day(std::uint32_t /*midnight_ms*/, std::uint16_t /*days_1984*/) {}
};

}  // namespace volcomp::node
