#pragma once
// The probe of a node: from what the drives latch to points that wait to be read. The tick collects
// touches, the background makes points of them.

#include "comp/probe/probe_corrector.hpp"
#include "comp/probe/touch_collector.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/probe/flank_probe.hpp"
#include "firmware/node/probe/point_fifo.hpp"
#include "firmware/node/probe/probe_objects.hpp"
#include "hal/ring.hpp"

namespace volcomp::node {

class ProbePath {
 public:
  ProbePath(ProbeObjects& objects, const NodeCompensator& compensator, Preemption* preemption)
      : objects_(objects),
        compensator_(compensator),
        preemption_(preemption),
        flank_(objects, preemption) {}

  void reset();

  // --- background, while the tick is kept out

  // Tables have been activated: this is their machine.
  void set_machine(const MachineDescription& machine);
  // Takes the settings of the objects over for the axes in `axes`, a bit each; those in `untimed`
  // do not say when they latched. `period_us` of SYNC. Refuses bad_setting, not_finite,
  // not_a_rotation; what was in force stays.
  Status apply(std::uint32_t axes, std::uint32_t untimed, std::uint32_t period_us);
  // The next touches are on this feature, its flank and, without one, its normal are those of the
  // objects. Refuses bad_setting, neither a unit vector nor 0, and what FlankProbe::take() refuses;
  // the feature stays.
  [[nodiscard]] Reason take_feature(std::uint32_t index);
  // As FlankProbe::load_gear().
  [[nodiscard]] Reason load_gear(std::uint32_t id) { return flank_.load_gear(id); }
  void switch_off() { on_ = false; }

  // Makes a point of the next touch; the tick may come meanwhile. False when there was none, or
  // while tables are being exchanged.
  bool work();
  // work() has something to do.
  [[nodiscard]] bool waiting() const { return overrun_ != 0 || !touches_.empty(); }
  [[nodiscard]] const ProbePoint& last() const { return last_; }

  [[nodiscard]] PointFifo& points() { return points_; }
  // The last touch found no room.
  [[nodiscard]] bool losing() const { return losing_; }
  // A point has been taken out of points().
  void released();

  // --- tick

  [[nodiscard]] bool on() const { return on_; }
  // The counters of the drives are not known any more.
  void restart() { collector_.restart(); }
  void report(std::size_t axis, const LatchReport& report) { collector_.report(axis, report); }
  void end_cycle();

 private:
  // `judged` is filled in when the point is one of an announced flank. The tick may come meanwhile.
  [[nodiscard]] ProbePoint point_of(const Touch& touch, JudgedTouch& judged) const;
  void publish(const ProbePoint& point, const Touch& touch, const JudgedTouch& judged);
  void publish(const JudgedTouch& judged, std::uint32_t sequence);

  ProbeObjects& objects_;
  const NodeCompensator& compensator_;
  Preemption* preemption_;
  TouchCollector collector_{};
  hal::Ring<Touch, 4> touches_{};  // tick → background
  std::uint32_t overrun_ = 0;      // touches that found it full
  ProbeCorrector corrector_{};
  ProbeFeature feature_{};
  FlankProbe flank_;
  PointFifo points_{};
  ProbePoint last_{};
  bool has_machine_ = false;
  bool losing_ = false;
  bool on_ = false;
};

}  // namespace volcomp::node
