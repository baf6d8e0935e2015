#pragma once
// The CAN port of hal/can_port.hpp over SocketCAN: a raw socket on one interface, by name. One
// thread at a time.
//
//   SocketCan port;
//   if (const OpenStatus s = port.open("can0"); !s.ok()) print("can0: ", sentence(s.result));
//
// An interface that goes down leaves the socket open: network_down() reports it, and traffic
// resumes by itself when it is up again. One that was removed needs open() once more.

#include <cstdint>

#include "comp/core/span.hpp"
#include "hal/can_port.hpp"
#include "hal/linux/open_status.hpp"

struct can_frame;

namespace volcomp::hal {

// Received frames that CANopen has no use for: 29-bit identifiers, remote requests, error reports
// of the controller. They wrap around.
struct SkippedFrames {
  std::uint32_t extended = 0;
  std::uint32_t remote = 0;
  std::uint32_t error = 0;
};

class SocketCan {
 public:
  SocketCan() = default;
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;
  ~SocketCan() { close(); }

  // Closes what was open before. Fails with failed, no_can_in_kernel, no_such_interface,
  // not_a_can_interface or interface_down; the port is then closed.
  OpenStatus open(const char* interface);
  void close();

  // False when the queue of the interface is full, the network is down or the port is closed.
  bool send(const CanFrame& frame);

  // The same for a remote request of `size` bytes (0…8): a guarding frame of CANopen.
  bool send_remote(std::uint16_t id, std::uint8_t size);

  // False when nothing is there, and after kMaxSkippedAtOnce useless frames in a row.
  bool receive(CanFrame& frame);
  // From now on frames of this socket come back among the received ones, in the order of the bus:
  // with a driver that echoes (IFF_ECHO) when they have been on it, otherwise when the kernel has
  // taken them. False: the kernel refuses.
  bool hear_own() const;
  // The frame of the last receive() is one that this socket has sent.
  [[nodiscard]] bool own() const { return own_; }
  // How long ago the kernel took in the frame of the last receive(): what a process that was not
  // running has missed. At most kMostAge_us, 0 where it is not known.
  [[nodiscard]] std::uint32_t age_us() const;
  static constexpr std::uint32_t kMostAge_us = 1'000'000;

  // From now on only frames with these identifiers (11 bits, at most kMostFilters) arrive, and the
  // reports of the controller: no other frame wakes the process. False: the kernel refuses, and all
  // arrive as before.
  bool hear_only(Span<const std::uint16_t> ids) const;
  // Frames that the kernel has dropped since the last call because the receive buffer was full.
  // Known only with the next frame that arrives.
  [[nodiscard]] std::uint32_t take_losses();
  // Errors that the controller has reported since the last call: warning, passive, bus-off, a
  // buffer that was full, a frame that could not be sent.
  [[nodiscard]] std::uint32_t take_errors();

  // Sleeps until there is something to receive or the time is over; true in the first case. A
  // signal ends it early with false.
  [[nodiscard]] bool wait(std::uint32_t timeout_us) const;

  // The last attempt to send or receive found the interface down or gone.
  [[nodiscard]] bool network_down() const { return network_down_; }
  [[nodiscard]] const SkippedFrames& skipped() const { return skipped_; }
  // State of the controller by the error reports seen by receive(); active until one reports
  // otherwise.
  [[nodiscard]] CanBusState bus_state() const { return bus_state_; }

  // For a caller that waits for several things at once; -1 when closed.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  static constexpr int kMaxSkippedAtOnce = 64;
  static constexpr std::size_t kMostFilters = 64;

 private:
  [[nodiscard]] OpenStatus attach(const char* interface);
  void note_failure();
  [[nodiscard]] bool give(const ::can_frame& raw);
  [[nodiscard]] bool take(::can_frame& raw);
  bool skip(const ::can_frame& raw);
  void note_error(const ::can_frame& raw);

  int descriptor_ = -1;
  bool network_down_ = false;
  SkippedFrames skipped_;
  std::int64_t taken_in_ns_ = 0;  // the last frame, CLOCK_REALTIME; 0: not known
  std::uint32_t dropped_ = 0;     // by the kernel since the socket was opened; wraps
  std::uint32_t losses_taken_ = 0;
  std::uint32_t errors_ = 0;  // since take_errors()
  bool own_ = false;
  CanBusState bus_state_ = CanBusState::active;
};

}  // namespace volcomp::hal
