#pragma once
// One simulated drive on a bench: frames by hand, one bus cycle at a time.

#include <vector>

#include "host_sim/sim/drives/cia402_drive.hpp"

namespace volcomp::sim {

using Frames = std::vector<hal::CanFrame>;

[[nodiscard]] hal::CanFrame frame(std::uint16_t id, const std::vector<std::uint8_t>& bytes);

class Bench {
 public:
  static constexpr std::uint8_t kNode = 3;
  static constexpr std::uint64_t kPeriod_us = 1000;

  explicit Bench(const Cia402Drive::Settings& settings = node_three());
  [[nodiscard]] static Cia402Drive::Settings node_three();
  [[nodiscard]] static Cia402Drive::Settings rotary();

  // Hands one frame over; what the drive sends before the next is stored in `sent`.
  void give(std::uint16_t id, const std::vector<std::uint8_t>& bytes);
  // Lets time pass in steps of 100 µs, without SYNC.
  void wait(std::uint64_t us);
  // RPDO1, RPDO2.
  void command(std::uint16_t controlword, std::int32_t target);
  void offset(std::int32_t units);
  // The rest of the period, then SYNC; afterwards `sent` holds what was sent since the last one.
  void sync();
  // command() and sync().
  void cycle(std::uint16_t controlword, std::int32_t target);
  // From power-on to operation enabled, following `target`; the axis should stand there.
  void enable(std::int32_t target = 0);
  void start_node() { give(0x000, {0x01, kNode}); }

  // SDO download of an INTEGER or UNSIGNED of `bytes` bytes; the abort code, 0 when written.
  std::uint32_t write(std::uint16_t index, std::uint8_t sub, std::int64_t value, std::size_t bytes);
  // Expedited SDO upload; the value with zeros above.
  [[nodiscard]] std::uint32_t read(std::uint16_t index, std::uint8_t sub);

  [[nodiscard]] std::uint16_t statusword() const { return drive.objects().statusword; }
  // The frame with this identifier among `sent`; size 0 when there is none.
  [[nodiscard]] hal::CanFrame find(std::uint16_t id) const;
  [[nodiscard]] std::size_t count(std::uint16_t id) const;

  Cia402Drive drive;
  std::uint64_t now_us = 0;
  Frames sent;
  Frames emergencies;  // all since power-on

 private:
  void collect();
  std::uint64_t last_sync_us_ = 0;
};

}  // namespace volcomp::sim
