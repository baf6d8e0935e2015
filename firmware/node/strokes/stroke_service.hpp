#pragma once
// Strokes of a helical grinder: hands the reports of axes and controller to the monitor and returns
// what it has learned as an offset of C (2500h). docs/papers/internal-helical.md, "What we do".
//
// The targets of a cycle take effect at the next SYNC, and so does the process state that comes
// with them; the positions of a cycle were taken at its own SYNC. So positions are compared with
// the targets of the cycle before, and the offset belongs to the targets of this one.

#include "comp/strokes/helix_instances.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/strokes/learned_image.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"
#include "firmware/node/wire_scale.hpp"

namespace volcomp::node {

// X, Z and C; in drive units.
inline constexpr std::size_t kStrokeAxes = 3;

struct StrokeAxisReport {
  std::int32_t target = 0;  // for the next SYNC
  std::int32_t actual = 0;  // at this one
  bool has_target = false;  // arrived in this cycle
  bool has_actual = false;
  bool homed = false;
};

struct StrokeCycle {
  std::array<StrokeAxisReport, kStrokeAxes> axis{};
  std::uint16_t syncs = 1;  // since the cycle before
  bool has_state = false;   // 201Ah arrived
  bool corrected = false;   // C gets offsets of this node
};

class StrokeService {
 public:
  StrokeService(StrokeObjects& objects, Preemption* preemption)
      : objects_(objects), preemption_(preemption) {}

  // --- background, while the tick is kept out

  // Takes 2500h…2505h over; tables become 0. `period_us` of SYNC. Refused, and strokes are off:
  // bad_setting and what HelixMonitor, StrokeOffsets and OffsetLearner refuse.
  Status switch_on(std::uint32_t period_us);
  // Also as after power-on.
  void switch_off() { on_ = false; }
  [[nodiscard]] bool on() const { return on_; }
  // OPERATIONAL begins: nothing is known of the axes. Refused, and strokes are off: bad_setting
  // ("tick_ns": a period above 1 s).
  Status restart(const std::array<WireScale, kStrokeAxes>& scale, std::uint32_t period_us);
  // Numbers of X, Z and C, from 0.
  [[nodiscard]] std::size_t axis(std::size_t which) const { return axis_[which]; }

  // Takes a pass that has ended into the sums; the tick may come meanwhile.
  void work();
  // 2520h. The tick may come meanwhile. Refused: bad_setting ("command": strokes are off; "target";
  // "wavelength" …), hand_over_pending, too_few_points (nothing was watched), breaks_helix,
  // feed_mismatch (several feeds, or another than that of the tables; value in mm/s), not_staged.
  Status learn(LearnCommand command);
  // 2510h…2515h as of now.
  void publish();

  // 2516h: means by node, table 1…3. Valid until the next call of one of these.
  [[nodiscard]] Span<const std::uint8_t> means(std::size_t table);
  // 2526h:01; empty while nothing has been learned.
  [[nodiscard]] Span<const std::uint8_t> image(std::uint32_t machine_id);
  [[nodiscard]] Span<std::uint8_t> buffer() { return {image_.data(), image_.size()}; }
  // The first `size` bytes of the buffer become the tables; in force after LearnCommand::resume.
  // Refused as by check_learned(), nothing changes.
  Status accept(std::size_t size, std::uint32_t machine_id);

  // --- tick

  // The offset goes to 0 at once; tables are kept.
  void stop() { offsets_.deactivate(); }
  // What C gets, 2^-32 turn.
  std::int32_t tick(const StrokeCycle& cycle);

 private:
  static constexpr std::size_t kX = 0;
  static constexpr std::size_t kZ = 1;
  static constexpr std::size_t kC = 2;

  // What is known of an axis when the next SYNC comes.
  struct Commanded {
    WireScale scale{};
    WirePosition counted{};
    std::int64_t position = 0;  // run-time units
    std::int32_t wire = 0;
    bool known = false;
  };

  static Status bad(const char* field);
  [[nodiscard]] static std::int32_t tick_ns(std::uint32_t period_us);
  [[nodiscard]] HelixMonitorSettings monitor_settings(std::uint32_t period_us) const;
  Status start_learners();
  [[nodiscard]] LearningRules stroke_rules() const;
  [[nodiscard]] LearningRules slot_rules() const;
  [[nodiscard]] LearnedLayout layout(std::uint32_t machine_id) const;

  [[nodiscard]] TrackedAxis tracked(const StrokeAxisReport& report, const Commanded& axis) const;
  [[nodiscard]] HelixFrame frame(const StrokeCycle& cycle) const;
  void take_commands(const StrokeCycle& cycle);
  [[nodiscard]] StrokeState state(const StrokeCycle& cycle) const;
  void show(std::int32_t offset);

  Status take_settings(std::uint32_t period_us);
  Status check_learning();
  Status check_feed() const;
  void forget();
  Status update();
  template <std::size_t Nodes>
  [[nodiscard]] LearnedTable step(OffsetLearner<Nodes>& learner, std::size_t table);
  void sums_of(std::size_t table, Span<NodeSums> out) const;
  Status put_in_force(std::int32_t feed);
  [[nodiscard]] std::size_t length(std::size_t table) const;
  void show_side(std::size_t direction);

  StrokeObjects& objects_;
  Preemption* preemption_;
  GrinderMonitor monitor_{};
  GrinderOffsets offsets_{};
  std::array<OffsetLearner<kStrokeNodes>, 2> stroke_{};
  OffsetLearner<kGearSlots> slot_{};
  // As they were taken over: the objects may have changed since.
  HelixMonitorSettings settings_{};
  LearningRules along_{};
  LearningRules around_{};
  std::size_t slots_ = 0;
  std::array<std::size_t, kStrokeAxes> axis_{};
  bool on_ = false;

  // --- of the tick
  std::array<Commanded, kStrokeAxes> commanded_{};
  std::uint16_t sequence_ = 0;
  std::uint16_t slot_ground_ = 0;
  std::uint16_t flags_ = 0;
  bool state_known_ = false;  // of the targets before
  // Since the last step, in the face.
  std::int32_t slowest_ = INT32_MAX;
  std::int32_t fastest_ = 0;

  std::array<NodeSums, kStrokeNodes> sums_{};            // of one table at a time
  std::array<std::uint8_t, kMostLearnedBytes> image_{};  // being read or written
};

}  // namespace volcomp::node
