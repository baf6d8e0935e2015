#pragma once
// The probe of the node (2300h…2411h): latches of the drives in, touches to the background, points
// out.

#include <type_traits>

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/probe/probe_path.hpp"

namespace volcomp::node {

class TouchProbe : public NodePart {
 public:
  explicit TouchProbe(NodeCore& core);

  void reset() { path_.reset(); }
  void restart(bool operational);
  // Makes a point of the next touch.
  void background(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t rests_until_us() const { return path_.waiting() ? 0 : UINT64_MAX; }
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
  void count_edge(std::size_t axis, LatchReport& report);
  [[nodiscard]] bool hears(std::size_t first, std::size_t end, std::uint32_t mapped) const;
  void note_what_is_told();
  canopen::AbortCode switch_to(ProbeCommand command);
  [[nodiscard]] canopen::AbortCode release_point(std::uint32_t sequence);
  void report_point();

  NodeCore& core_;
  ProbePath path_;
  PerAxis<std::int32_t> previous_actual_{};  // of the cycle before
  std::uint32_t had_actual_ = 0;             // a bit per axis
  // A bit per axis, from the RPDOs: drives that do not say when they latched, nor count (2018h and
  // 2019h are not mapped), and those whose status word of the probe comes every cycle (2015h).
  std::uint32_t untimed_ = 0;
  std::uint32_t uncounted_ = 0;
  std::uint32_t flagged_ = 0;
  std::uint32_t stored_ = 0;                // an edge, as last told in 2015h
  PerAxis<std::uint16_t> edges_counted_{};  // instead of 2019h
  bool touch_rejected_ = false;             // the last one
};

// A node that does not probe.
struct NoProbe : NodePart {
  explicit NoProbe(NodeCore& /*core*/) {}
  void end_cycle(std::uint8_t /*next_counter*/) {}
  void set_machine(const MachineDescription& /*machine*/) {}
};

using ProbePart = std::conditional_t<kProbes, TouchProbe, NoProbe>;

}  // namespace volcomp::node
