#pragma once
// The CAN port of hal/can_port.hpp over the frame pipe (hal/frame_pipe.hpp), by semihosting: turn
// by turn with the simulator of the bus. Virtual time stands still while the other end works, so a
// run repeats itself instruction by instruction.
//
//   PipePort port;
//   if (!port.open()) …                  // waits until the other end has opened, too
//   port.begin_turn();                   // waits for the turn of the other end
//   while (port.receive(frame)) …        // its frames
//   port.send(frame);                    // ours
//   port.end_turn();
//
// Also the clock of hal/clock.hpp: the time of the other end at its last turn.
//
// Once the other end has sent quit, is gone or sends nonsense, end() reports it, turns pass without
// frames and time stands still.

#include <array>
#include <cstddef>
#include <cstdint>

#include "comp/core/atomic_word.hpp"
#include "hal/can_port.hpp"
#include "hal/frame_pipe.hpp"
#include "hal/ring.hpp"

namespace volcomp::hal::mps2 {

class PipePort {
 public:
  // A millisecond at 1 Mbit/s is 21 frames; a host may send an SDO block of 127 at once.
  static constexpr std::size_t kMostReceived = 256;
  static constexpr std::size_t kMostSent = 64;

  enum class End : std::uint32_t { none, told_to_quit, gone, nonsense, too_many_frames };

  // False when the host has no such pipes or does not answer semihosting.
  [[nodiscard]] bool open();

  void begin_turn();
  void end_turn();

  // False when kMostSent frames wait for the end of the turn.
  bool send(const CanFrame& frame);
  bool receive(CanFrame& frame) { return received_.pop(frame); }

  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }
  // In any context.
  [[nodiscard]] End end() const { return end_.load(std::memory_order_relaxed); }

 private:
  [[nodiscard]] bool take(const PipeRecord& record);
  void finish(End end);
  void write_record(const PipeBytes& record);

  // All zero, so that a static port takes no flash; open() sets them.
  int to_node_ = 0;
  int from_node_ = 0;
  Ring<CanFrame, kMostReceived> received_;
  std::array<std::uint8_t, (kMostSent + 1) * kPipeRecordBytes> outgoing_{};
  std::size_t outgoing_bytes_ = 0;
  std::uint64_t now_us_ = 0;
  AtomicWord<End> end_{End::none};
};

}  // namespace volcomp::hal::mps2
