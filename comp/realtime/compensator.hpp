#pragma once
// The compensator: positions in, offsets out, once per tick.
//
//   error → inverse Jacobian → clamp → ramp → round → slew → output
//
// The slew limit comes last because it is the promise made to the drive: whatever happened before,
// including a change of tables in the middle of a ramp, no output moves by more than `rate` in one
// tick.
//
// Two contexts use it. The interrupt calls tick() only. The background calls everything else; it
// writes into the spare half of a double buffer and hands it over by one atomic flag, which tick()
// honours at its start. No locks, no heap, every loop bounded; on anything wrong the last good
// tables stay active.

#include <atomic>

#include "comp/realtime/direction.hpp"
#include "comp/realtime/limiter.hpp"
#include "comp/realtime/motion_inverse.hpp"
#include "comp/realtime/tick_types.hpp"

namespace volcomp {

// Knots per axis table; one more costs a five-axis compensator 960 bytes.
inline constexpr std::size_t kDefaultKnots = 128;

template <class Machine, std::size_t Knots = kDefaultKnots>
class Compensator {
 public:
  static constexpr std::size_t kAxes = Machine::kAxes;
  using Input = TickInput<kAxes>;
  using Output = TickOutput<kAxes>;
  using Settings = CompensatorSettings<kAxes>;
  using Tables = TableSet<kAxes, Knots>;

  Compensator() : Compensator(Machine{}) {}
  // A machine with more axes than fit is treated as none: every stage() is then refused.
  explicit Compensator(const Machine& machine)
      : machine_(machine.chain.axes <= kAxes ? machine : Machine{}),
        unknown_axes_(machine_.chain.axes) {
    for (std::size_t a = 0; a < kAxes; ++a)
      apply_limits(a);
  }

  // --- background

  // Before the first tick or while stopped. Refuses bad_setting with the field named.
  Status configure(const Settings& settings);

  // As if constructed anew for this machine; the settings stay, tables and diagnostics go. Only
  // while no tick can come.
  void restart(const Machine& machine);

  // Offsets the drives hold at start-up (read back): the first tick continues from them instead of
  // jumping to 0. Refuses bad_setting beyond ±2^30 units (1.07 m): no drive stands there.
  Status start_from(const std::array<std::int32_t, kAxes>& offsets);

  // Folds tables for a functional point into the spare buffer. Used for new tables and for a tool
  // change alike. On refusal the active tables go on. `image_crc` is what diagnostics will report.
  // Not while a hand-over is pending. A node stages the view of an image (check_image); tables in
  // memory are for the host: their view takes 4 KB of stack.
  Status stage(const TablesView& tables, const Vec3& tool_point, std::uint32_t image_crc);
  Status stage(const MachineTables& tables, const Vec3& tool_point, std::uint32_t image_crc);

  // Hands the staged set over: active from the next tick, ramped in. Refuses not_staged.
  Status activate();

  // Corrections ramp to 0 and stay there until the next activate().
  void deactivate() { request_.store(Request::deactivate, std::memory_order_release); }

  // Does at once what the next tick would begin with. Only while no tick can come.
  void settle() {
    if (pending()) take_request();
  }

  // Recomputes the checksum of the active tables; call it from time to time. A bit that changed in
  // memory means: crc_mismatch, corrections ramp to 0, every axis shows kTableDamaged until new
  // tables are activated.
  Status scrub();

  [[nodiscard]] bool pending() const {
    return request_.load(std::memory_order_acquire) != Request::none;
  }
  [[nodiscard]] bool active() const { return active_ >= 0; }
  [[nodiscard]] const FoldReport& fold_report() const { return report_; }
  [[nodiscard]] const Diagnostics<kAxes>& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const Machine& machine() const { return machine_; }

  // --- interrupt

  void tick(const Input& in, Output& out);

  // The uncorrected, unlimited error of the last tick in base (nm), for telemetry.
  [[nodiscard]] const Float3& last_error_nm() const { return error_nm_; }

 private:
  enum class Request : std::uint8_t { none, activate, deactivate };

  // No two accepted positions of a linear axis are further apart.
  static constexpr std::int64_t kAnyStep = 2 * kMaxPosition;
  static constexpr std::int64_t kAnyTurn = 2 * kMaxTurningPosition;

  // One cache line per axis: what was configured, then what changes.
  struct AxisState {
    std::int64_t most_step = kAnyStep;  // largest plausible |Δposition|
    float limit = 0.0F;
    std::int32_t rate = 1;
    std::int32_t soft_rate = 1;
    std::int32_t hysteresis = 0;
    std::int64_t position = 0;  // last good one
    std::int64_t seen = 0;      // last one given, good or implausible
    std::int32_t output = 0;
    std::int32_t ramp_from = 0;
    DirectionTracker direction;
    std::uint16_t stale_ticks = 0;
    std::uint16_t status = 0;
    bool known = false;   // has ever had a valid position
    bool steady = false;  // known, and the last sample was good
    bool soft = false;    // dropped, not homed or coming back: soft_rate instead of rate
  };
  using StatusWords = std::array<std::uint32_t, kAxes>;
  struct PutOut {
    std::int32_t output;
    std::uint32_t status;
  };

  template <class Visit>
  void for_each_axis(const Visit& visit) const;
  void begin_change();
  void take_request();
  [[nodiscard]] bool in_reach(std::size_t axis, std::int64_t position) const;
  std::uint32_t take_sample(std::size_t axis, const AxisSample& sample);
  std::uint32_t take_unusual_sample(std::size_t axis, const AxisSample& sample);
  Located place(std::size_t axis, const Tables& set, bool add_offset, std::uint32_t& status);
  kernel::Offsets wanted_offsets(StatusWords& status);
  PutOut put_out(AxisState& s, float wanted, float ramp, std::uint32_t status);
  PutOut put_out_unusual(AxisState& s, float wanted, float ramp, std::uint32_t status);
  void count_changes(std::size_t axis, std::uint32_t status);
  void apply_limits(std::size_t axis);
  Status open_spare(const Provenance& provenance);
  Status fold_into_spare(const TablesView& tables, const Vec3& tool_point, std::uint32_t image_crc);
  Status reject(const Status& status);
  static std::uint32_t checksum(const Tables& set);
  [[nodiscard]] bool rotary(std::size_t axis) const {
    return machine_.chain.kind[axis] == JointKind::rotary;
  }

  Machine machine_{};
  Settings settings_{};
  std::array<Tables, 2> buffer_{};
  std::array<AxisState, kAxes> axis_{};
  std::uint32_t unknown_axes_ = 0;  // that have never had a valid position
  Ramp ramp_{};
  Float3 error_nm_{};
  FoldReport report_{};
  Diagnostics<kAxes> diagnostics_{};
  std::atomic<Request> request_{Request::none};
  std::int8_t active_ = -1;  // index of the active buffer, −1 = none
  std::int8_t next_ = 0;     // the spare one
  bool staged_ = false;
  std::atomic<bool> damaged_{false};
};

}  // namespace volcomp

#include "comp/realtime/compensator_background.inl"
#include "comp/realtime/compensator_tick.inl"
