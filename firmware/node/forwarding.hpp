#pragma once
// Axes whose drives have no position offset: the node hears the target of the controller, adds the
// offset, and the drive takes the sum as its 607Ah (way 1). Controlword and NMT go from the
// controller to the drive as ever, also when the node is dead.
//
//   1. Every target that is sent is one of the controller plus an offset of the gate, and the gate
//      moves once in a cycle in which such a frame has left, at no other time. So from one target
//      that a drive takes to the next it moves by what the controller moved, plus at most 2202h
//      (and less at the end of INTEGER32, where the sum is cut: FF03h).
//   2. None is made up, none is sent twice, none is kept beyond the next SYNC.
//   3. A controller sets its target to 6064h when it enables a drive, or after homing. Therefore
//      the offset is 0 while the drive is known not to follow targets, and then for as many targets
//      as can be under way; then it comes softly. A drive that was told to disable and enable again
//      without a status in between counts as one that did not follow.
//   4. A node that stood still and went on would make a drive jump. Targets that came but did not
//      leave before the next SYNC, or left and were on the bus only after it (where the port
//      tells), more than 2200h:04 in a row, end the forwarding for all axes, and so do frames lost
//      and bus-off. It begins anew only with a drive that has been seen not to follow, as after a
//      start of the node.
//
//   unseen ──does not follow──► ready ──follows──► beginning ──2 × 2200h:04 + 3 targets──┐
//                                 ▲                    │                                 ▼
//                                 └──does not follow───┴───────does not follow────── following
//
// Nothing is sent while the mapping of the drive is not known to be the right one (2037h): the same
// frame would be an offset for a drive that is mapped for way 0.

#include "firmware/node/node_core.hpp"

namespace volcomp::node {

class Forwarding {
 public:
  explicit Forwarding(NodeCore& core) : core_(core) {}

  // The settings are those of the objects, nothing is known of the drives.
  void restart(bool operational);

  [[nodiscard]] bool any() const { return axes_ != 0; }
  // One bit each, as in all that follows.
  [[nodiscard]] std::uint32_t axes() const { return axes_; }
  [[nodiscard]] bool has(std::size_t axis) const { return (axes_ & bit(axis)) != 0; }
  // A drive follows targets of this node: it stops when they end.
  [[nodiscard]] bool drives_follow() const;
  // The drive of this axis may be given an offset other than 0.
  [[nodiscard]] bool takes_offset(std::size_t axis) const;
  // The drive gets nothing, or does not hear what it gets.
  [[nodiscard]] bool silent(std::size_t axis) const;
  // An axis waits, has lost its forwarding or got no target in this cycle: bit 15 of 2600h:03.
  [[nodiscard]] bool incomplete() const;
  // A sum has been cut at the end of INTEGER32.
  [[nodiscard]] bool cut(std::size_t axis) const { return (cut_ & bit(axis)) != 0; }
  // The last target before SYNC was on the bus only after it.
  [[nodiscard]] bool late(std::size_t axis) const { return (late_ & bit(axis)) != 0; }

  // --- tick

  // Axes whose last target lies in the port, which tells when a frame has been on the bus: the next
  // one waits until then, so that never two are under way and none is older than it seems. A port
  // that does not tell has none.
  void unconfirmed(std::uint32_t axes);
  // `at_once`: the offsets of the cycle are known, targets wait for nothing.
  void arrived(std::uint32_t bits, bool at_once, std::uint64_t now_us);
  // SYNC: what still waits has missed it.
  void end_cycle();
  // A SYNC that opens no cycle, but the drives take what they have at it.
  void foreign_sync() {
    if (waits_ != 0) end_cycle();
  }
  // Before the samples of a cycle: what each drive does.
  void judge();
  // The offset of the cycle in units of the drive, then the target, if it has come.
  void put_out(std::size_t axis, std::int32_t wanted);
  // The frame of this axis has been handed to the port.
  void sent(std::size_t axis);
  // 2208h.
  void watch_clock(std::uint64_t now_us);
  // Nothing is forwarded until every drive has been seen not to follow.
  void end();
  // 2037h: nobody can have mapped a drive that is known not to be OPERATIONAL for good.
  [[nodiscard]] canopen::AbortCode check_mapping(std::size_t axis, std::uint8_t way) const;
  // The drive has booted, 2034h was written: how it is mapped is not known any more.
  void forget_mapping(std::size_t axis);

 private:
  enum class Phase : std::uint8_t { unseen, ready, beginning, following };
  struct Axis {
    std::uint64_t target_us = 0;   // when the last target came
    std::int32_t rest_target = 0;  // of the cycle before
    Phase phase = Phase::unseen;
    std::uint8_t begun = 0;   // targets since it began to follow
    std::uint8_t missed = 0;  // targets in a row that came and did not leave
    std::uint8_t rested = 0;  // cycles at rest
    bool unmoved = false;     // it does not move with the offset
    bool unclear = false;     // told to disable, no status since
  };

  void see(std::size_t axis, bool follows);
  void see_status(std::size_t axis);
  void see_control(std::size_t axis);
  void listen(std::size_t axis);
  void note_actual(std::size_t axis);
  void miss(std::size_t axis);
  void be_late(std::size_t axis);
  void send(std::size_t axis);
  void add(std::size_t axis);
  void withdraw(std::size_t axis);
  void lose(std::size_t axis);
  void show_heartbeat();
  [[nodiscard]] bool follows(std::size_t axis) const {
    return has(axis) && axis_[axis].phase >= Phase::beginning;
  }
  [[nodiscard]] bool may_send(std::size_t axis) const;
  [[nodiscard]] bool known_stopped(std::size_t axis) const;

  NodeCore& core_;
  PerAxis<Axis> axis_{};
  std::uint32_t axes_ = 0;     // of way 1, while OPERATIONAL; bits, as the following
  std::uint32_t waits_ = 0;    // a target is on offer
  std::uint32_t left_ = 0;     // one has left since SYNC
  std::uint32_t stepped_ = 0;  // the gate knows of the offset of this cycle
  std::uint32_t cut_ = 0;
  std::uint32_t unconfirmed_ = 0;
  std::uint32_t late_ = 0;
  bool ended_ = false;
  bool starved_ = false;  // 2208h: a following axis has had no target for too long
};

}  // namespace volcomp::node
