#pragma once
// The compensation node behind the links of this program, each in a thread of its own: over a frame
// pipe as volcomp-node and the firmware are, and as an SLCAN adapter on a pseudo-terminal.

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "firmware/canopen/exchange.hpp"
#include "firmware/node/node.hpp"
#include "hal/linux/node_pipe.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/slcan.hpp"
#include "host_sim/host/bus/links/descriptor.hpp"

namespace volcomp::host {

inline constexpr std::uint8_t kLinuxNode = 32;

class PipeNode {
 public:
  explicit PipeNode(const std::string& folder) {
    EXPECT_TRUE(pipe_.open(folder.c_str()).ok());
    thread_ = std::thread([this] { serve(); });
  }
  PipeNode(const PipeNode&) = delete;
  PipeNode& operator=(const PipeNode&) = delete;
  ~PipeNode() {
    stop_ = true;
    thread_.join();
  }

 private:
  void serve() {
    const auto node = std::make_unique<node::Node>(kLinuxNode, nullptr);
    node->power_on(0);
    while (!stop_ && !pipe_.ended()) {
      if (!pipe_.begin_turn(1000)) continue;
      canopen::exchange(node->device(), pipe_, pipe_.now_us());
      pipe_.end_turn();
    }
  }

  BrokenPipeIgnored broken_pipe_ignored_;
  hal::NodePipe pipe_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// What is sent on the line is stored.
class SlcanNode {
 public:
  SlcanNode() {
    int line = -1;
    int device = -1;
    std::array<char, 64> name{};
    EXPECT_EQ(::openpty(&line, &device, name.data(), nullptr, nullptr), 0);
    line_ = Descriptor(line);
    device_ = Descriptor(device);  // so that the line stays while no other end is open
    device_name_ = name.data();
    static_cast<void>(::fcntl(line, F_SETFL, O_NONBLOCK));
    thread_ = std::thread([this] { serve(); });
  }
  SlcanNode(const SlcanNode&) = delete;
  SlcanNode& operator=(const SlcanNode&) = delete;
  ~SlcanNode() {
    if (thread_.joinable()) stop();
  }
  // The node answers no more.
  void stop() {
    stop_ = true;
    thread_.join();
  }

  [[nodiscard]] const std::string& device_name() const { return device_name_; }
  // After stop().
  [[nodiscard]] const std::string& heard() const { return heard_; }
  [[nodiscard]] bool channel_open() const { return adapter_.open(); }

  // --- the port of the node
  bool send(const hal::CanFrame& frame) {
    if (adapter_.open()) write(hal::slcan_frame(frame));
    return true;
  }
  bool receive(hal::CanFrame& frame) {
    for (char c = 0; ::read(line_.number(), &c, 1) == 1;) {
      heard_ += c;
      const hal::SlcanRequest request = adapter_.take(c);
      if (request.kind == hal::SlcanRequest::Kind::answer) write(request.answer);
      if (request.kind != hal::SlcanRequest::Kind::frame) continue;
      put(&hal::kSlcanOk, 1);
      frame = request.frame;
      return true;
    }
    return false;
  }

 private:
  void write(const hal::SlcanText& text) { put(text.data(), text.size()); }
  void put(const char* bytes, std::size_t size) {
    EXPECT_EQ(::write(line_.number(), bytes, size), static_cast<ssize_t>(size));
  }

  void serve() {
    const hal::SteadyClock clock;
    const auto node = std::make_unique<node::Node>(kLinuxNode, nullptr);
    node->power_on(clock.now_us());
    while (!stop_) {
      canopen::exchange(node->device(), *this, clock.now_us());
      pollfd waiting{line_.number(), POLLIN, 0};
      static_cast<void>(::poll(&waiting, 1, 1));
    }
  }

  Descriptor line_;
  Descriptor device_;
  std::string device_name_;
  std::string heard_;
  hal::SlcanDevice adapter_{kLinuxNode};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace volcomp::host
