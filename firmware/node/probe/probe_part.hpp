#pragma once
// The probe of the node (2300h…2411h): latches of the drives in, touches to the background, points
// out.

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/probe/probe_path.hpp"

namespace volcomp::node {

class ProbePart : public NodePart {
 public:
  explicit ProbePart(NodeCore& core)
      : core_(core), path_(core.objects.probe, core.compensator, core.preemption) {}

  void reset() { path_.reset(); }
  void restart(bool operational);
  // Makes a point of the next touch.
  void background(std::uint64_t now_us);
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
    constexpr std::uint16_t kOwn = object::probe::command.index;
    constexpr std::uint16_t kBehind = object::stroke::command.index;
    const bool own = object.index >= kOwn && object.index < kBehind;
    return own ? check_write(object, bytes) : canopen::AbortCode::none;
  }
  static bool owns_domain(canopen::ObjectId object) {
    return object == object::probe::oldest_point.id();
  }
  canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source);

  // Tick: everything of the cycle has arrived when the next SYNC comes.
  void end_cycle(std::uint8_t next_counter);
  // Tables have been activated: this is their machine.
  void set_machine(const MachineDescription& machine) { path_.set_machine(machine); }

 private:
  canopen::AbortCode check_write(canopen::ObjectId object, Span<const std::uint8_t> bytes);
  [[nodiscard]] bool probes() const;
  [[nodiscard]] LatchReport latch_report(std::size_t axis, bool consecutive) const;
  canopen::AbortCode switch_to(ProbeCommand command);
  [[nodiscard]] canopen::AbortCode release_point(std::uint32_t sequence);
  void report_point();

  NodeCore& core_;
  ProbePath path_;
  PerAxis<std::int32_t> previous_actual_{};  // of the cycle before
  std::uint32_t had_actual_ = 0;             // a bit per axis
  bool touch_rejected_ = false;              // the last one
};

}  // namespace volcomp::node
