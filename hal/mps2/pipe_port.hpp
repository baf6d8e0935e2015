#pragma once
// The CAN port of hal/can_port.hpp over the frame pipe (hal/frame_pipe.hpp), by semihosting: turn
// by turn with whoever simulates the bus. Virtual time stands still while the other end works, so a
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
// Ends the program when the other end tells it to (0), is gone or talks nonsense (2): without it
// there is no bus.

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/can_port.hpp"
#include "hal/frame_pipe.hpp"
#include "hal/ring.hpp"

namespace volcomp::hal::mps2 {

class PipePort {
 public:
  // A millisecond at 1 Mbit/s is 21 frames; a host that has been configured otherwise may send
  // more.
  static constexpr std::size_t kMostReceived = 512;
  static constexpr std::size_t kMostSent = 64;

  // False when the host has no such pipes or nobody listens to semihosting.
  [[nodiscard]] bool open();

  void begin_turn();
  void end_turn();

  // False when kMostSent frames wait for the end of the turn.
  bool send(const CanFrame& frame);
  bool receive(CanFrame& frame) { return received_.pop(frame); }

  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }

 private:
  void write_record(const PipeBytes& record);

  int to_node_ = -1;
  int from_node_ = -1;
  Ring<CanFrame, kMostReceived> received_;
  std::array<std::uint8_t, (kMostSent + 1) * kPipeRecordBytes> outgoing_{};
  std::size_t outgoing_bytes_ = 0;
  std::uint64_t now_us_ = 0;
};

}  // namespace volcomp::hal::mps2
