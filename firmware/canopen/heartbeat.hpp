#pragma once
// Heartbeat consumer (CiA 301, section 7.2.8.2.2): watches the nodes named in 1016h, each from its
// first message on.

#include <array>
#include <cstdint>

#include "firmware/canopen/communication_objects.hpp"
#include "firmware/canopen/nmt.hpp"

namespace volcomp::canopen {

enum class HeartbeatEvent : std::uint8_t { lost, back, booted };

class HeartbeatConsumer {
 public:
  explicit HeartbeatConsumer(const CommunicationObjects& objects) : objects_(objects) {}

  // A message of `node`. True when that is news: `event` is back or booted.
  bool heard(std::uint8_t node, NmtState state, std::uint64_t now_us, HeartbeatEvent& event);

  // A watched node that has fallen silent since the last call, one per call.
  bool overdue(std::uint64_t now_us, std::uint8_t& node);
  // Before this time there is none; UINT64_MAX: never; 0: after something was heard, until the next
  // overdue(), which else compares two times instead of looking at every node.
  [[nodiscard]] std::uint64_t next_overdue_us() const { return next_us_; }

  // State in the last message of a watched node; boot_up when nothing is known.
  [[nodiscard]] NmtState state(std::uint8_t node) const;
  [[nodiscard]] bool alive(std::uint8_t node) const;

  // Sub-index 1…kHeartbeatConsumers of 1016h changed: its watching starts anew. True when the node
  // watched until now was lost; no later call reports it again.
  bool restart(std::uint8_t sub, std::uint8_t& lost_node);
  // Communication was reset.
  void reset() {
    watch_ = {};
    next_us_ = UINT64_MAX;
  }

 private:
  struct Watch {
    std::uint64_t last_us = 0;
    NmtState state = NmtState::boot_up;
    std::uint8_t node = 0;
    bool started = false;
    bool lost = false;
  };
  [[nodiscard]] std::size_t slot(std::uint8_t node) const;

  const CommunicationObjects& objects_;
  std::array<Watch, kHeartbeatConsumers> watch_{};
  std::uint64_t next_us_ = UINT64_MAX;  // when overdue() looks at every node again
};

}  // namespace volcomp::canopen
