#pragma once
// A CAN bus inside the process, in virtual time: the same calls give the same trace, bit for bit.
// One frame at a time is on the bus and every other connected port receives it, unless a fault was
// requested.
//
//   LoopbackBus bus;                                  // 1 Mbit/s
//   LoopbackBus::Port& a = bus.attach("controller");
//   LoopbackBus::Port& b = bus.attach("drive 1");
//   a.send({0x080, 0, {}});
//   while (bus.step(until_ns)) { … let every participant receive() and send() … }
//
// There is no acknowledge: a frame without a receiver counts as sent. Without faults no call of
// step(), send() or receive() allocates memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/can_port.hpp"

namespace volcomp::hal {

// A first-in, first-out queue of CAN frames with a fixed capacity, allocated once.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) : frames_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const CanFrame& front() const { return frames_[first_]; }

  // False when full.
  bool push(const CanFrame& frame) {
    if (size_ == frames_.size()) return false;
    const std::size_t at = first_ + size_;
    frames_[at < frames_.size() ? at : at - frames_.size()] = frame;
    ++size_;
    return true;
  }

  // False when empty.
  bool pop(CanFrame& frame) {
    if (empty()) return false;
    frame = frames_[first_];
    drop();
    return true;
  }
  // Not when empty. An empty queue begins anew, so that a short one stays in the cache.
  void drop() {
    --size_;
    first_ = size_ > 0 && first_ + 1 < frames_.size() ? first_ + 1 : 0;
  }

  void clear() { size_ = first_ = 0; }

 private:
  std::vector<CanFrame> frames_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

// What a frame's time on the bus is computed from; see frame_bits.hpp.
enum class FrameLength : std::uint8_t {
  nominal,     // 47 + 8 n bits, no stuffing: the cheapest, up to a fifth too short
  exact,       // the stuff bits its content takes; ten times the work
  worst_case,  // the most stuff bits a frame of this size can have
};

class LoopbackBus {
 public:
  class Port;

  // What happens to one frame on its way to one receiver. The copies of a frame that is received
  // twice follow each other, both after the delay.
  struct Fate {
    bool lost = false;
    bool twice = false;
    std::uint64_t delay_ns = 0;  // from the end of the frame; later frames may overtake
  };
  using FaultHook =
      std::function<Fate(const CanFrame& frame, const Port& sender, const Port& receiver)>;

  // Called once for every frame at its end, before anybody receives it.
  using Observer =
      std::function<void(std::uint64_t time_ns, const CanFrame& frame, const Port& sender)>;

  // bit_rate: bit/s, at least 1 (std::invalid_argument otherwise).
  explicit LoopbackBus(std::uint32_t bit_rate = 1'000'000,
                       FrameLength length = FrameLength::nominal);
  LoopbackBus(const LoopbackBus&) = delete;
  LoopbackBus& operator=(const LoopbackBus&) = delete;
  ~LoopbackBus();

  // A new port, connected. The reference stays valid as long as the bus.
  Port& attach(std::string name, std::size_t transmit_capacity = 64);

  [[nodiscard]] std::uint64_t now_ns() const { return now_ns_; }

  // The next thing that happens. True, with the time at its end:
  //   a frame was sent, of the first frames of all ports the one with the lowest identifier (of
  //   equal ones the lower port number). It has to start before until_ns and may end after it, so
  //   the time overshoots by one frame at most. Delayed copies that fall due meanwhile are
  //   received just before it;
  //   or, with nothing to send, the delayed copies due next, not later than until_ns, were
  //   received.
  // False when neither is there: the time is then until_ns, or unchanged where that is past.
  bool step(std::uint64_t until_ns);

  // An empty function switches off. The functions may use ports, but not call step() or attach().
  void set_fault_hook(FaultHook hook) { fault_hook_ = std::move(hook); }
  void set_observer(Observer observer) { observer_ = std::move(observer); }

  // While on, every send() of every port is refused; what is queued still goes out.
  void set_full(bool on) { full_ = on; }

  // Sums over all frames sent so far.
  [[nodiscard]] std::uint64_t busy_ns() const { return busy_ns_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  [[nodiscard]] std::uint64_t duration_ns(const CanFrame& frame) const;

 private:
  struct Delivery {
    CanFrame frame;
    Port* receiver = nullptr;
  };

  [[nodiscard]] Port* winner() const;
  void transmit(Port& sender);
  void deliver(const CanFrame& frame, const Port& sender);
  void deliver_with_faults(const CanFrame& frame, const Port& sender, Port& receiver);
  void release_delayed(std::uint64_t until_ns);
  void forget_delayed(const Port& receiver);
  [[nodiscard]] std::uint64_t bits_to_ns(std::uint64_t bits) const;

  std::uint32_t bit_rate_;
  FrameLength length_;
  std::array<std::uint64_t, 9> duration_by_size_ns_{};
  std::vector<std::unique_ptr<Port>> ports_;
  std::multimap<std::uint64_t, Delivery> delayed_;  // equal times keep the order of insertion
  FaultHook fault_hook_;
  Observer observer_;
  std::uint64_t now_ns_ = 0;
  std::uint64_t busy_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::size_t pending_ = 0;  // frames in all transmit queues
  bool full_ = false;
};

// One participant's CAN controller; satisfies IsCanPort.
class LoopbackBus::Port {
 public:
  static constexpr std::size_t kReceiveCapacity = 256;

  struct Counters {
    std::uint64_t sent = 0;      // frames that went over the bus
    std::uint64_t refused = 0;   // send() calls that returned false
    std::uint64_t received = 0;  // frames put into the receive queue or kept out by the filter
    std::uint64_t overrun = 0;   // frames dropped because that was full
  };

  // False when the transmit queue or the bus is full, the port is disconnected or refuses. Throws
  // std::invalid_argument for an identifier above 7FFh or more than 8 bytes.
  bool send(const CanFrame& frame);
  bool receive(CanFrame& frame) { return receive_.pop(frame); }
  // The frame that receive() would return, nullptr where there is none; and drops it. It stays
  // until skip(), receive(), a disconnection or the next step().
  [[nodiscard]] const CanFrame* first() const {
    return receive_.empty() ? nullptr : &receive_.front();
  }
  void skip() { receive_.drop(); }

  // Which frames are received, as an acceptance filter of a CAN controller decides it; an empty
  // function: all. It is asked when a frame arrives and none waits: one that waits may change the
  // answer, so all behind it are received. It must not use the bus.
  using Filter = std::function<bool(const CanFrame& frame)>;
  void set_filter(Filter filter) { filter_ = std::move(filter); }

  // Disconnecting empties both queues and drops what is delayed on its way here.
  void connect(bool on);
  [[nodiscard]] bool connected() const { return connected_; }

  // While on, every send() is refused; what is queued still goes out, and frames are received.
  void refuse(bool on) { refuses_ = on; }

  // Frames ready for receive(), and frames still to be sent.
  [[nodiscard]] std::size_t waiting() const { return receive_.size(); }
  [[nodiscard]] std::size_t unsent() const { return transmit_.size(); }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t number() const { return number_; }  // in order of attach(), from 0
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  friend class LoopbackBus;
  Port(LoopbackBus& bus, std::string name, std::size_t number, std::size_t transmit_capacity);
  void put(const CanFrame& frame);

  LoopbackBus& bus_;
  std::string name_;
  std::size_t number_;
  FrameQueue transmit_;
  FrameQueue receive_{kReceiveCapacity};
  Counters counters_;
  Filter filter_;
  bool connected_ = true;
  bool refuses_ = false;
};

}  // namespace volcomp::hal
