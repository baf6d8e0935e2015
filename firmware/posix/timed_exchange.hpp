#pragma once
// canopen/exchange.hpp with the time at which each frame came in and left: a process that was not
// running sees how late it is (2620h), and a second SYNC producer by the time between two SYNCs.
// And with the proof that forwarded targets were on the bus, in its order: which of two SYNCs came
// first after a target is known.

#include <algorithm>
#include <cstdint>

#include "firmware/node/node.hpp"
#include "firmware/posix/sending_proof.hpp"

namespace volcomp::posix {

// The axis whose targets this frame carries; kNodeAxes: none.
inline std::size_t forwarded_axis(const node::Node& node, std::uint16_t id) {
  const Span<canopen::Pdo> pdos = node.device().pdos().transmit();
  std::size_t axis = 0;
  while (axis < node::kNodeAxes &&
         ((node.forwarded_axes() >> axis & 1U) == 0 || !pdos[axis].answers_to(id)))
    ++axis;
  return axis;
}

// `Port` as hal/linux/lasting_can.hpp.
template <class Port, class Clock>
class TimedExchange {
 public:
  explicit TimedExchange(const Clock& clock) : clock_(clock) {}

  void turn(node::Node& node, Port& port) {
    hal::CanFrame frame;
    while (port.receive(frame)) {
      if (port.own())
        take_back(node, frame);
      else
        node.device().receive(frame, time_of_frame(port));
    }
    latest_us_ = std::max(latest_us_, clock_.now_us());
    // What the frames have made ready waits for none of the work of poll(), which may be long.
    send_all(node, port);
    no_proof_ = proof_.finds_no_proof(latest_us_) || no_proof_;
    node.unconfirmed(proof_.unconfirmed());
    node.device().poll(latest_us_);
    send_all(node, port);
  }

  // The port was closed or is off the bus.
  void forget_sent(node::Node& node) {
    proof_.forget();
    node.unconfirmed(0);
  }
  // True once: the port does not give back what it has sent.
  [[nodiscard]] bool take_no_proof() {
    const bool told = no_proof_;
    no_proof_ = false;
    return told;
  }

 private:
  void send_all(node::Node& node, Port& port) {
    hal::CanFrame frame;
    while (node.device().offer(frame, latest_us_) && port.send(frame)) {
      node.device().taken(latest_us_ = clock_.now_us());
      note_target(node, frame);
    }
  }

  std::uint64_t time_of_frame(const Port& port) {
    const std::uint64_t now = clock_.now_us();
    const std::uint64_t age = std::min<std::uint64_t>(port.age_us(), now);
    latest_us_ = std::max(latest_us_, now - age);  // the time of the node never goes back
    return latest_us_;
  }

  void take_back(node::Node& node, const hal::CanFrame& frame) {
    const std::size_t axis = forwarded_axis(node, frame.id);
    if (axis == node::kNodeAxes) return;
    proof_.came_back(axis, clock_.now_us());
    node.unconfirmed(proof_.unconfirmed());
  }

  void note_target(node::Node& node, const hal::CanFrame& frame) {
    const std::size_t axis = forwarded_axis(node, frame.id);
    if (axis == node::kNodeAxes) return;
    proof_.handed_over(axis, latest_us_);
    node.unconfirmed(proof_.unconfirmed());
  }

  const Clock& clock_;
  SendingProof proof_;
  std::uint64_t latest_us_ = 0;
  bool no_proof_ = false;
};

}  // namespace volcomp::posix
