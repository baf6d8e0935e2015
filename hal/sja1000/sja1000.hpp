#pragma once
// The CAN port of hal/can_port.hpp on an SJA1000 in PeliCAN mode, by interrupt. Section numbers:
// data sheet SJA1000, Philips Semiconductors, 2000 Jan 04.
//
//   struct MyRegisters {                               // how the chip is wired to the processor
//     std::uint8_t read(std::uint8_t address) const;   // addresses of hal/sja1000/registers.hpp
//     void write(std::uint8_t address, std::uint8_t value) const;
//   };
//   struct MyInterruptLock { MyInterruptLock(); ~MyInterruptLock(); };  // keeps out on_interrupt()
//
//   hal::Sja1000<MyRegisters, MyInterruptLock> can;
//   can.start(registers, settings);     once
//   can.on_interrupt();                 from the interrupt of the chip
//   can.supervise(now_us);              every millisecond or so
//   can.send(frame);                    from any context, on_interrupt() apart
//   can.receive(frame);                 from one context
//
// Frames leave by identifier, not in the order of the calls; a frame that already waits in the
// chip's only transmit buffer is taken back for a more urgent one. No call blocks, loops are
// bounded by the queue (kSendCapacity) or by the chip's FIFO (21 frames).
//
// Bus-off: what waits is lost, send() refuses, and after kBusOffPause_us the chip is set to join
// the bus again, which it does after 128 × 11 recessive bits (ISO 11898-1).
//
// Both acceptance filters pass every data frame with an 11-bit identifier. Remote frames, which no
// service of the node uses, end in the chip; of the 29-bit frames the filters let half through, and
// they are thrown away here. Why not the simpler single filter: QEMU 7.2 shifts its mask the wrong
// way (hw/net/can/can_sja1000.c, can_sja_single_filter) and loses frames.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/can_port.hpp"
#include "hal/frame_ring.hpp"
#include "hal/sja1000/registers.hpp"

namespace volcomp::hal {

// Frames waiting for a CAN controller, in the order in which the bus would let them through: lowest
// identifier first, frames with the same identifier as they came. So a long SDO answer never holds
// up an offset. Fixed capacity; every call costs at most one pass over the waiting frames.
template <std::size_t Capacity>
class SendQueue {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  // Not while empty.
  [[nodiscard]] const CanFrame& front() const { return frames_[size_ - 1]; }

  // False when full.
  bool push(const CanFrame& frame) {
    if (size_ == Capacity) return false;
    insert_before_lower(frame, [&](const CanFrame& waiting) { return waiting.id <= frame.id; });
    return true;
  }

  // A frame taken before that could not leave: ahead of those with its identifier. There is always
  // a place for one.
  void put_back(const CanFrame& frame) {
    if (size_ > Capacity) return;
    insert_before_lower(frame, [&](const CanFrame& waiting) { return waiting.id < frame.id; });
  }

  // Not while empty.
  CanFrame pop() { return frames_[--size_]; }

  void clear() { size_ = 0; }

 private:
  // Keeps the most urgent frame last, where taking it moves no other.
  template <class GoesFirst>
  void insert_before_lower(const CanFrame& frame, GoesFirst goes_first) {
    const auto end = frames_.begin() + static_cast<std::ptrdiff_t>(size_);
    const auto place = std::find_if(frames_.begin(), end, goes_first);
    std::copy_backward(place, end, end + 1);
    *place = frame;
    ++size_;
  }

  std::array<CanFrame, Capacity + 1> frames_{};
  std::size_t size_ = 0;
};

// How the chip is wired and clocked; section 6.5.
struct Sja1000Settings {
  std::uint8_t bus_timing_0 = 0;
  std::uint8_t bus_timing_1 = 0;
  std::uint8_t output_control = 0;
  std::uint8_t clock_divider = 0;  // without the PeliCAN bit, which the driver sets
};

// They wrap around.
struct Sja1000Counters {
  std::uint32_t sent = 0;
  std::uint32_t received = 0;
  std::uint32_t refused = 0;        // by send(): queue full or bus-off
  std::uint32_t taken_back = 0;     // waited in the chip, replaced by a more urgent frame
  std::uint32_t extended = 0;       // 29-bit identifiers, thrown away
  std::uint32_t fifo_overruns = 0;  // the chip lost one or more frames
  std::uint32_t ring_overruns = 0;  // frames lost because receive() was called too rarely
  std::uint32_t bus_offs = 0;
};

template <class Registers, class InterruptLock>
class Sja1000 {
 public:
  static constexpr std::size_t kSendCapacity = 32;
  static constexpr std::size_t kReceiveCapacity = 64;
  static constexpr std::uint64_t kBusOffPause_us = 100'000;

  // Sets the chip up and joins the bus. False when nothing behind the registers acts like an
  // SJA1000.
  [[nodiscard]] bool start(Registers registers, const Sja1000Settings& settings);

  void on_interrupt();
  // Ends a bus-off after its pause; joins again, too, when the chip was reset behind our back.
  void supervise(std::uint64_t now_us);

  bool send(const CanFrame& frame);
  bool receive(CanFrame& frame) { return received_.pop(frame); }

  // How often frames of the bus were lost since the last call.
  [[nodiscard]] std::uint32_t take_losses();

  [[nodiscard]] CanBusState state() const;
  [[nodiscard]] Sja1000Counters counters() const;

 private:
  [[nodiscard]] std::uint8_t read(std::uint8_t address) const { return registers_.read(address); }
  void write(std::uint8_t address, std::uint8_t value) const { registers_.write(address, value); }
  void command(std::uint8_t bits) const;

  [[nodiscard]] bool enter_reset_mode() const;
  void configure() const;
  void join_bus();

  void take_all();
  void take_one();
  void feed_transmitter();
  void unload(bool sent);
  void load(const CanFrame& frame);
  void note_bus_state();

  Registers registers_{};
  Sja1000Settings settings_{};
  SendQueue<kSendCapacity> waiting_;
  FrameRing<kReceiveCapacity> received_;
  CanFrame loaded_{};  // in the chip's transmit buffer
  bool is_loaded_ = false;
  bool taking_back_ = false;  // an abort is under way
  CanBusState state_ = CanBusState::stopped;
  std::uint64_t in_reset_since_us_ = 0;
  Sja1000Counters counters_;
  std::uint32_t losses_told_ = 0;
};

}  // namespace volcomp::hal

#include "hal/sja1000/sja1000.inl"
