#include "hal/loopback/loopback_bus.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "hal/loopback/frame_bits.hpp"

namespace volcomp::hal {

LoopbackBus::LoopbackBus(std::uint32_t bit_rate, FrameLength length)
    : bit_rate_(bit_rate), length_(length) {
  if (bit_rate == 0) throw std::invalid_argument("a bus needs a bit rate");
  for (std::size_t size = 0; size < duration_by_size_ns_.size(); ++size) {
    duration_by_size_ns_[size] = bits_to_ns(
        length == FrameLength::worst_case ? worst_case_frame_bits(size) : nominal_frame_bits(size));
  }
}

LoopbackBus::~LoopbackBus() = default;

LoopbackBus::Port& LoopbackBus::attach(std::string name, std::size_t transmit_capacity) {
  ports_.push_back(
      std::unique_ptr<Port>(new Port(*this, std::move(name), ports_.size(), transmit_capacity)));
  return *ports_.back();
}

bool LoopbackBus::step(std::uint64_t until_ns) {
  if (pending_ > 0 && now_ns_ < until_ns) {
    transmit(*winner());
    return true;
  }
  if (!delayed_.empty() && delayed_.begin()->first <= until_ns) {
    now_ns_ = delayed_.begin()->first;
    release_delayed(now_ns_);
    return true;
  }
  now_ns_ = std::max(now_ns_, until_ns);
  return false;
}

LoopbackBus::Port* LoopbackBus::winner() const {
  Port* best = nullptr;
  unsigned lowest_id = kMaxCanId + 1U;  // above all that send() lets pass
  for (const auto& port : ports_) {
    if (port->transmit_.empty() || port->transmit_.front().id >= lowest_id) continue;
    best = port.get();
    lowest_id = best->transmit_.front().id;
  }
  return best;
}

void LoopbackBus::transmit(Port& sender) {
  CanFrame frame;
  sender.transmit_.pop(frame);
  --pending_;
  ++sender.counters_.sent;
  ++frames_;
  const std::uint64_t duration = duration_ns(frame);
  busy_ns_ += duration;
  now_ns_ += duration;
  if (!delayed_.empty()) release_delayed(now_ns_);
  if (observer_) observer_(now_ns_, frame, sender);
  deliver(frame, sender);
}

void LoopbackBus::deliver(const CanFrame& frame, const Port& sender) {
  for (const auto& receiver : ports_) {
    if (receiver.get() == &sender || !receiver->connected_) continue;
    if (fault_hook_) {
      deliver_with_faults(frame, sender, *receiver);
    } else {
      receiver->put(frame);
    }
  }
}

void LoopbackBus::deliver_with_faults(const CanFrame& frame, const Port& sender, Port& receiver) {
  const Fate fate = fault_hook_(frame, sender, receiver);
  if (fate.lost || !receiver.connected_) return;
  for (int copy = 0; copy < (fate.twice ? 2 : 1); ++copy) {
    if (fate.delay_ns > 0) {
      delayed_.emplace(now_ns_ + fate.delay_ns, Delivery{frame, &receiver});
    } else {
      receiver.put(frame);
    }
  }
}

void LoopbackBus::release_delayed(std::uint64_t until_ns) {
  const auto end = delayed_.upper_bound(until_ns);
  for (auto it = delayed_.begin(); it != end; it = delayed_.erase(it))
    it->second.receiver->put(it->second.frame);
}

void LoopbackBus::forget_delayed(const Port& receiver) {
  for (auto it = delayed_.begin(); it != delayed_.end();)
    it = it->second.receiver == &receiver ? delayed_.erase(it) : std::next(it);
}

std::uint64_t LoopbackBus::duration_ns(const CanFrame& frame) const {
  return length_ == FrameLength::exact ? bits_to_ns(exact_frame_bits(frame))
                                       : duration_by_size_ns_[frame.size];
}

std::uint64_t LoopbackBus::bits_to_ns(std::uint64_t bits) const {
  return bits * 1'000'000'000U / bit_rate_;
}

LoopbackBus::Port::Port(LoopbackBus& bus, std::string name, std::size_t number,
                        std::size_t transmit_capacity)
    : bus_(bus), name_(std::move(name)), number_(number), transmit_(transmit_capacity) {}

bool LoopbackBus::Port::send(const CanFrame& frame) {
  if (frame.id > kMaxCanId || frame.size > frame.data.size())
    throw std::invalid_argument("a frame that no CAN bus can carry");
  if (!connected_ || refuses_ || bus_.full_ || !transmit_.push(frame)) {
    ++counters_.refused;
    return false;
  }
  ++bus_.pending_;
  return true;
}

void LoopbackBus::Port::connect(bool on) {
  if (connected_ && !on) {
    bus_.pending_ -= transmit_.size();
    transmit_.clear();
    receive_.clear();
    bus_.forget_delayed(*this);
  }
  connected_ = on;
}

void LoopbackBus::Port::put(const CanFrame& frame) {
  const bool kept_out = filter_ && receive_.empty() && !filter_(frame);
  ++(kept_out || receive_.push(frame) ? counters_.received : counters_.overrun);
}

}  // namespace volcomp::hal
