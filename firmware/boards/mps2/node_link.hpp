#pragma once
// How the node of this board reaches its bus, chosen when it starts: by the frame pipe (default),
// or by SLCAN on UART0. To the node it is one CAN port with one clock; see node_task.hpp.

#include "hal/mps2/clock.hpp"
#include "hal/mps2/pipe_port.hpp"
#include "hal/mps2/slcan_port.hpp"

namespace volcomp::boards {

class NodeLink {
 public:
  // Reads the last word of the semihosting command line: "slcan"; anything else, or no debugger,
  // selects the pipe. False when the frame pipe cannot be opened.
  [[nodiscard]] bool open();

  [[nodiscard]] bool is_pipe() const { return is_pipe_; }
  [[nodiscard]] const hal::mps2::PipePort& pipe() const { return pipe_; }
  [[nodiscard]] hal::mps2::SlcanPort& slcan() { return slcan_; }

  // A turn of the pipe is a tick of the node; SLCAN knows no turns.
  void begin_turn() {
    if (is_pipe_) pipe_.begin_turn();
  }
  void end_turn() {
    if (is_pipe_) pipe_.end_turn();
  }
  bool send(const hal::CanFrame& frame) {
    return is_pipe_ ? pipe_.send(frame) : slcan_.send(frame);
  }
  bool receive(hal::CanFrame& frame) {
    return is_pipe_ ? pipe_.receive(frame) : slcan_.receive(frame);
  }

  // In the pipe the time of the host, so that the node and the bus have one time.
  [[nodiscard]] std::uint64_t now_us() const { return is_pipe_ ? pipe_.now_us() : clock_.now_us(); }

 private:
  hal::mps2::PipePort pipe_;
  hal::mps2::SlcanPort slcan_;
  hal::mps2::Clock clock_;
  bool is_pipe_ = false;  // open() decides
};

}  // namespace volcomp::boards
