#pragma once
// The node's end of a frame pipe (hal/frame_pipe.hpp) on Linux: a CAN port whose clock is the
// host's. What a node does over it depends on the frames alone, never on the computer.
//
//   NodePipe port;
//   if (const OpenStatus s = port.open("/tmp/node"); !s.ok()) …
//   while (!port.ended()) {
//     if (!port.begin_turn(timeout_us)) continue;
//     canopen::exchange(node, port, port.now_us());
//     port.end_turn();
//   }

#include <cstdint>

#include "hal/frame_pipe.hpp"
#include "hal/linux/open_status.hpp"
#include "hal/ring.hpp"

namespace volcomp::hal {

class NodePipe {
 public:
  static constexpr std::size_t kMostReceived = 4096;  // frames of one turn

  NodePipe() = default;
  NodePipe(const NodePipe&) = delete;
  NodePipe& operator=(const NodePipe&) = delete;
  ~NodePipe() { close(); }

  // The pipes are made where they are missing; the host may come later. Fails with failed,
  // no_such_folder or not_a_pipe.
  OpenStatus open(const char* folder);
  void close();

  // True when the host has finished its turn; false when the time is over before, or for good.
  [[nodiscard]] bool begin_turn(std::uint32_t timeout_us);
  bool receive(CanFrame& frame) { return received_.pop(frame); }
  // False when the host is gone.
  bool send(const CanFrame& frame) { return write_record(pipe_frame(frame)); }
  void end_turn();

  // The host has quit, is gone, sends nonsense or more than kMostReceived frames.
  [[nodiscard]] bool ended() const { return ended_; }
  // The host's time at the end of its last turn.
  [[nodiscard]] std::uint64_t now_us() const { return now_us_; }

 private:
  [[nodiscard]] bool await_data(std::uint32_t timeout_us) const;
  [[nodiscard]] bool open_answer();
  [[nodiscard]] bool read_record(PipeRecord& record);
  [[nodiscard]] bool write_record(const PipeBytes& bytes);

  int folder_ = -1;
  int to_node_ = -1;
  int from_node_ = -1;
  Ring<CanFrame, kMostReceived> received_;
  std::uint64_t now_us_ = 0;
  bool ended_ = false;
};

}  // namespace volcomp::hal
