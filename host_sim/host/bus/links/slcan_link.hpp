#pragma once
// An SLCAN adapter as a link (hal/slcan.hpp): a real one on a serial line, or the firmware of an
// emulated board on its UART.

#include <deque>
#include <string>

#include "hal/linux/steady_clock.hpp"
#include "hal/slcan.hpp"
#include "host_sim/host/bus/links/frame_link.hpp"
#include "host_sim/host/bus/links/serial_device.hpp"

namespace volcomp::host {

class SlcanLink final : public FrameLink {
 public:
  // Opens the channel at 1 Mbit/s. Throws UserError naming the device when it does not answer as an
  // adapter does.
  explicit SlcanLink(const std::string& device);
  SlcanLink(const SlcanLink&) = delete;
  SlcanLink& operator=(const SlcanLink&) = delete;
  // Closes the channel as far as the device still listens.
  ~SlcanLink() override;

  // No room while kMostUnanswered frames have not been acknowledged.
  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  void wait(std::uint32_t timeout_us) override;
  [[nodiscard]] std::uint64_t now_us() const override { return clock_.now_us(); }
  [[nodiscard]] bool turn_by_turn() const override { return false; }

  // Adapters hold a few frames; so many are on their way at most.
  static constexpr std::size_t kMostUnanswered = 8;

 private:
  using Event = hal::SlcanLine::Event;

  void open_channel();
  void await_version();
  void command(const char* text, const char* refusal);
  void flush();
  [[nodiscard]] Event next_event();
  [[nodiscard]] Event await_event(std::uint64_t until_us);
  void take(Event event);
  void answered();
  [[noreturn]] void fail(const char* what) const;

  SerialDevice device_;
  hal::SteadyClock clock_;
  hal::SlcanLine line_;
  std::string outgoing_;
  std::string incoming_;
  std::deque<hal::CanFrame> received_;
  std::size_t unanswered_ = 0;  // frames sent
};

}  // namespace volcomp::host
