#pragma once
// A way for CAN frames to and from nodes that are not in this process.
//
//   const std::unique_ptr<FrameLink> link = open_frame_link("vcan0");
//   link->send(frame);
//   link->wait(1000);
//   while (link->receive(frame)) …
//
// Every function throws UserError naming the link when it is of no use any more.

#include <cstdint>
#include <memory>
#include <string>

#include "hal/can_port.hpp"

namespace volcomp::host {

class FrameLink {
 public:
  FrameLink() = default;
  FrameLink(const FrameLink&) = delete;
  FrameLink& operator=(const FrameLink&) = delete;
  virtual ~FrameLink() = default;

  // False: no room, nothing taken; try again after wait().
  [[nodiscard]] virtual bool send(const hal::CanFrame& frame) = 0;
  // A remote request of `size` bytes, for a guarding frame. False: this link cannot send one, or no
  // room.
  [[nodiscard]] virtual bool send_remote(std::uint16_t /*id*/, std::uint8_t /*size*/) {
    return false;
  }
  // False: nothing there.
  [[nodiscard]] virtual bool receive(hal::CanFrame& frame) = 0;
  // Lets the other end work: until a frame has arrived, or about this long.
  virtual void wait(std::uint32_t timeout_us) = 0;
  // The time of the other end, from any start.
  [[nodiscard]] virtual std::uint64_t now_us() const = 0;
  // That time advances with wait() alone: what is done over this link repeats itself bit for bit.
  [[nodiscard]] virtual bool turn_by_turn() const = 0;
};

// What `--can` accepts, for help texts.
inline constexpr const char* kLinkForms =
    "a SocketCAN interface (vcan0), pipe:FOLDER (frame pipe, see hal/frame_pipe.hpp) or "
    "slcan:DEVICE (serial line or socket of an SLCAN adapter)";

// Opens the link of that name. Throws UserError naming it and why it cannot be opened.
[[nodiscard]] std::unique_ptr<FrameLink> open_frame_link(const std::string& name);

}  // namespace volcomp::host
