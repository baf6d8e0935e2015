#pragma once
// The cycle of the node. SYNC n comes; controller and drives send their process data; when all of
// it is there, or at the deadline, the compensator ticks and the offsets leave in the same cycle;
// the drives take them together with 607Ah at SYNC n + 1. What is missing at the deadline is stale:
// the axis is held, then ramped down, the others go on.

#include "firmware/node/forwarding.hpp"
#include "firmware/node/latency.hpp"
#include "firmware/node/look_ahead.hpp"
#include "firmware/node/node_core.hpp"
#include "firmware/node/probe/probe_part.hpp"
#include "firmware/node/strokes/stroke_part.hpp"
#include "firmware/node/wire_scale.hpp"

namespace volcomp::node {

class NodeCycle : public NodePart {
 public:
  NodeCycle(NodeCore& core, ProbePart& probe, StrokePart& strokes)
      : core_(core), probe_(probe), strokes_(strokes), forwarding_(core) {}

  // --- the contract of a part

  void reset();
  // Nothing is known of the drives, and nothing is corrected; the settings are taken over.
  void restart(bool operational);
  void arrived(std::uint32_t bits, std::uint64_t now_us);
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) const {
    if (object.index == object::start_offset.index) return check_start(object.sub);
    if (object.index == object::mapped_way.index && object.sub != 0)
      return forwarding_.check_mapping(object.sub - 1U, bytes[0]);
    const bool unbuilt = object.index == object::way.index && object.sub != 0 &&
                         static_cast<Way>(bytes[0]) == Way::forwarded_frame;
    return unbuilt ? canopen::AbortCode::invalid_value : canopen::AbortCode::none;
  }
  void written(canopen::ObjectId object) {
    if (object.index == object::start_offset.index) note_start(object.sub);
    if (object.index == object::way.index) forwarding_.forget_mapping(object.sub - 1U);
    if (object == object::latency_cycles.id()) latency_.clear();
  }
  void before_read(canopen::ObjectId object);
  static bool owns_domain(canopen::ObjectId object) {
    return object == object::latency_histogram.id();
  }
  canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) const;

  // --- tick

  // Offsets that drives hold and cannot report (2206h), then the status: after restart().
  void begin();
  void sync(std::uint8_t counter, std::uint64_t now_us);
  void bad_sync(canopen::SyncVerdict verdict);
  // Computes when the deadline is over.
  void due(std::uint64_t now_us);
  // A transmit PDO has been handed to the port.
  void sent(std::size_t transmit_pdo);
  // A drive has fallen silent or has booted: what it holds is not known any more.
  void drive_gone(std::uint8_t node, bool booted);
  [[nodiscard]] std::uint32_t forwarded_axes() const { return forwarding_.axes(); }
  void unconfirmed(std::uint32_t axes) { forwarding_.unconfirmed(axes); }
  void end_forwarding() { forwarding_.end(); }
  [[nodiscard]] bool drives_follow() const { return forwarding_.drives_follow(); }
  void report_status();

  // When due() has something to do at the latest; UINT64_MAX while no cycle is open.
  [[nodiscard]] std::uint64_t deadline_us() const { return open_ ? deadline_us_ : UINT64_MAX; }
  // Forwarding watches the clock.
  [[nodiscard]] std::uint64_t rests_until_us() const {
    return forwarding_.any() ? 0 : deadline_us();
  }
  // No drive holds a correction of this node, or none can be changed any more.
  [[nodiscard]] bool at_rest() const;

 private:
  [[nodiscard]] canopen::AbortCode check_start(std::uint8_t sub) const;
  void note_start(std::uint8_t sub);
  [[nodiscard]] bool complete() const;
  [[nodiscard]] bool too_soon(std::uint64_t now_us) const;
  [[nodiscard]] std::uint64_t deadline_after_sync_us() const;
  void compute();
  bool start_compensating();
  [[nodiscard]] AxisSample sample(std::size_t axis);
  [[nodiscard]] bool can_correct(std::size_t axis);
  [[nodiscard]] bool keeps_turn(std::size_t axis);
  [[nodiscard]] std::int64_t without_added(std::size_t axis, std::int64_t position) const;
  void put_out();
  [[nodiscard]] std::int32_t wanted(std::size_t axis, std::int32_t learned);
  void send_offset(std::size_t axis, std::int32_t wanted);
  [[nodiscard]] bool silent(std::size_t axis) const;
  void report_axis_errors(std::size_t axis, std::uint16_t status);
  void raise_if(bool present, canopen::ErrorCode code, std::size_t axis, std::uint16_t status);
  void start_at_given_offsets();

  NodeCore& core_;
  ProbePart& probe_;
  StrokePart& strokes_;
  Forwarding forwarding_;
  Latency latency_{};
  PerAxis<WirePosition> position_{};
  PerAxis<LookAhead> ahead_{};  // where the controller adds
  TickOutput<kNodeAxes> output_{};
  std::uint64_t deadline_us_ = 0;
  std::uint64_t sync_us_ = 0;              // when the cycle was opened
  std::uint32_t used_ = 0;                 // axes, while OPERATIONAL
  std::uint32_t confirming_ = 0;           // of these, whose drives report their offsets
  std::uint32_t start_given_ = 0;          // 2206h written since the last start, a bit per axis
  PerAxis<std::uint16_t> clean_cycles_{};  // without trouble, per axis
  std::uint16_t clean_syncs_ = 0;          // since the last bad SYNC
  bool open_ = false;                      // SYNC has come, not yet computed
  bool refused_ = false;                   // the ways of the axes do not fit
};

}  // namespace volcomp::node
