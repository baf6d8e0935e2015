#pragma once
// The compensator: positions in, offsets out, once per tick.
//
//   error → inverse Jacobian → clamp → ramp → round → rate and acceleration → output
//
// Where axes orient the tool, they come first, and what their offsets do to the tool point is
// part of the error that the others take away.
//
// The limiter comes last because it is the promise made to the drive: whatever happened before,
// including a change of tables in the middle of a ramp, no output moves by more than `rate` in one
// tick, nor changes its step by more than `acceleration` (offset_limiter.hpp).
//
// Two contexts use it, on one core or on two. The interrupt calls tick() only. The background calls
// everything else; it writes into the spare half of a double buffer, then a pointer to the tables
// that are to be in force, then a flag, which tick() honours at its start: it clears the flag
// before it reads the pointer, so that of several requests the last one counts and none is lost. No
// locks, no heap, every loop bounded; on anything wrong the last good tables stay active.

#include <atomic>

#include "comp/core/atomic_word.hpp"
#include "comp/core/crc32.hpp"
#include "comp/core/published.hpp"
#include "comp/core/span.hpp"
#include "comp/tables/direction.hpp"
#include "comp/tick/limiter.hpp"
#include "comp/tick/motion_inverse.hpp"
#include "comp/tick/offset_limiter.hpp"
#include "comp/tick/status_tally.hpp"
#include "comp/tick/tick_types.hpp"
#include "comp/tick/tool_turning.hpp"
#include "comp/tick/touch.hpp"

namespace volcomp {

// Knots per axis table; one more costs a five-axis compensator 960 bytes.
inline constexpr std::size_t kDefaultKnots = 128;

namespace detail {

// What is not on the fast path. Internal linkage lets the compiler tail-jump, which frees the fast
// path's frame: GCC tail-jumps to nothing the linker may replace, such as instances of templates.
template <class Unit>
static void tick_limited(Unit& unit, std::uint32_t limited, std::uint32_t ended, float ramp,
                         typename Unit::Output& out);
template <class Unit>
static void tick_slow_path(Unit& unit, const typename Unit::Input& in, std::size_t first,
                           float ramp, typename Unit::Output& out);

}  // namespace detail

// `Limiter`: OffsetLimiter<false> for a board whose drives need no bound on the acceleration of an
// offset. Settings with one are then refused.
template <class Machine, std::size_t Knots = kDefaultKnots, class Limiter = OffsetLimiter<true>>
class Compensator {
 public:
  static constexpr std::size_t kAxes = Machine::kAxes;
  static constexpr bool kOrients = Machine::kOrienting != 0;
  using Input = TickInput<kAxes>;
  using Output = TickOutput<kAxes>;
  using Settings = CompensatorSettings<kAxes>;
  using Tables = TableSet<kAxes, Knots>;

  Compensator() : Compensator(Machine{}) {}
  // A machine with more axes than fit is treated as none: every stage() is then refused, as is one
  // whose axes orient the tool where Machine has no room for that.
  [[gnu::cold]] explicit Compensator(const Machine& machine)
      : machine_(machine.chain.axes <= kAxes ? machine : Machine{}) {
    next_ramp_.restart(settings_.ramp_ticks);
    take_machine();
  }

  // --- background; cold: for size where the tick is compiled for speed

  // Before the first tick or between two. Refuses bad_setting with the field named. An offset
  // beyond a smaller limit goes back to it by `rate` a tick, whatever ramp is under way or held;
  // the axis shows kClamped and kRateLimited until it is there. A new ramp_ticks counts for the
  // next change.
  [[gnu::cold]] Status configure(const Settings& settings);

  // As if constructed anew for this machine; the settings stay, tables and diagnostics go. Only
  // while no tick can come.
  [[gnu::cold]] void restart(const Machine& machine);

  // Offsets the drives hold at start-up (read back): the first tick continues from them instead of
  // jumping to 0. One beyond the limit goes back to it like after configure(). Refuses bad_setting
  // beyond ±2^30 units (1.07 m): no drive stands there.
  [[gnu::cold]] Status start_from(const std::array<std::int32_t, kAxes>& offsets);

  // The drive of this axis takes no offset at present and will begin with none: the output is 0 at
  // once, then it follows by soft_rate. Between two ticks, in the context of the tick.
  [[gnu::cold]] void begin_at_zero(std::size_t axis) {
    AxisState& s = axis_[axis];
    s.out.start(0);
    s.ramp_from = 0.0F;
    s.soft = true;
    guarded_axes_ |= 1U << axis;
  }

  // Folds tables for a functional point and axes as grown as in the view into the spare buffer.
  // Used for new tables, for a change of the tool and for axes that have become warmer alike. On
  // refusal the active tables go on. `image_crc` is what diagnostics will report. Not while a
  // hand-over is pending. A node stages the view of an image (check_image); tables in memory are
  // for the host: their view takes 4 KB of stack.
  Status stage(const TablesView& tables, const Vec3& tool_point, std::uint32_t image_crc);
  Status stage(const MachineTables& tables, const Vec3& tool_point, std::uint32_t image_crc,
               const Temperatures& temperatures = kUnknownTemperatures);

  // Folds tables of another machine: whatever becomes of it, this one and its tables go on. When it
  // is ok, adopt() that machine, or stage() again.
  [[gnu::cold]] Status stage_for(const RuntimeChain& chain, const TablesView& tables,
                                 const Vec3& tool_point, std::uint32_t image_crc);

  // restart() for the machine of stage_for(), with the tables it staged. Only while no tick can
  // come.
  [[gnu::cold]] void adopt(const Machine& machine);

  // No change is being ramped in: time for the next one.
  [[nodiscard]] bool at_rest() const { return (ramps_.get() & 1U) == 0 && !pending(); }

  // Hands the staged set over: active from the next tick, ramped in. Refuses not_staged.
  [[gnu::cold]] Status activate();

  // Corrections ramp to 0 and stay there until the next activate().
  [[gnu::cold]] void deactivate();

  // Does at once what the next tick would begin with. Only while no tick can come.
  [[gnu::cold]] void settle() {
    if (pending()) take_request<false>();
  }

  // Looks for bits that have changed in what a tick works with: active tables, chain of the
  // machine, settings and what was derived from them. Reads up to `bytes` of them and goes on there
  // next time; kScrubBytes are one pass, of which `bytes` may leave two pieces incomplete. A pass
  // begins anew with other tables. A changed bit means: crc_mismatch (`where.field` names what is
  // not a table), corrections ramp to 0, every axis shows kTableDamaged until new tables are
  // activated; settings need configure() before, a chain restart().
  [[gnu::cold]] Status scrub(std::size_t bytes);
  static constexpr std::size_t kScrubBytes = sizeof(Machine) + sizeof(Tables);

  // One whole pass at once.
  [[gnu::cold]] Status scrub();

  [[nodiscard, gnu::noinline]] bool pending() const {
    return requested_.load(std::memory_order_relaxed) != 0 ||
           now_.active.acquire() != wanted_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool active() const { return now_.active.get() != nullptr; }
  [[nodiscard]] const FoldReport& fold_report() const { return report_; }
  [[nodiscard, gnu::cold]] Diagnostics<kAxes> diagnostics() const;
  [[nodiscard]] const Machine& machine() const { return machine_; }

  // The error of the active tables at a latched pose (comp/tick/touch.hpp): positions of
  // encoders, so no offset is added to them. The tick may come meanwhile. Not pending().
  [[nodiscard]] PoseError error_at(const std::array<LatchedAxis, kMaxAxes>& latched) const;

  // --- interrupt

  // The direction in which an axis arrived where it is. With targets as positions
  // (PositionSource::target) a correcting axis is where target and offset take it, if
  // directions_follow_offsets(): a standing axis that the correction of another has moved back has
  // turned, too. Its hysteresis is then at least FoldReport::reversal_nm of the tables in either
  // buffer, so that no reversal leads to another.
  [[nodiscard]] Direction direction(std::size_t axis) const {
    return axis_[axis].direction.direction();
  }

  void tick(const Input& in, Output& out);

  // The uncorrected, unlimited error of the last tick in base (nm), for telemetry.
  [[nodiscard]] const Float3& last_error_nm() const { return error_nm_; }

 private:
  // The thread sanitizer does not know fences.
#if defined(__SANITIZE_THREAD__)
  static constexpr std::memory_order kAfterFence = std::memory_order_acquire;
#else
  static constexpr std::memory_order kAfterFence = std::memory_order_relaxed;
#endif

  // No two accepted positions of a linear axis are further apart.
  static constexpr std::int64_t kAnyStep = 2 * kMaxPosition;
  static constexpr std::uint32_t kNoAxes = 1U << 31U;              // guarded without tables
  static constexpr std::int64_t kAnyTurn = std::int64_t{1} << 62;  // half of what wraps
  struct AxisState {
    // what the fast path reads and writes, in its order
    std::int64_t seen = 0;    // position given last, good or implausible
    std::uint64_t reach = 0;  // fast_path_step while a sample may take the fast path, else 0
    Published<std::int32_t> hysteresis = 0;  // may become wider between two ticks
    DirectionTracker direction;
    Magnitude limit;
    float ramp_from = 0.0F;  // 0 unless a ramp is under way
    Limiter out;

    // what only the exceptions need
    std::uint64_t fast_path_step = 0;    // samples of the fast path are closer to the last one
    std::uint64_t most_step = kAnyStep;  // largest plausible |Δposition|
    std::int64_t position = 0;           // last good one, unless steady: then it is the one seen
    std::uint16_t stale_ticks = 0;
    std::uint16_t exception = 0;  // status bits that the sample of this tick raised
    bool known = false;           // has ever had a valid position
    bool steady = false;          // known, and the last sample was good
    bool soft = false;            // dropped, not homed or coming back: soft_rate instead of rate
  };

  // What the last change brought. The tick writes it.
  struct Change {
    Published<const Tables*> active = nullptr;
    Ramp ramp{};
  };

  // Axes that the next tick is to treat as guarded or limited: both in one word, one register.
  struct NextTick {
    static constexpr unsigned kLimited = 16;  // the bit of its first axis
    [[nodiscard]] std::uint32_t guarded() const { return word & ((1U << kLimited) - 1U); }
    [[nodiscard]] std::uint32_t limited() const { return word >> kLimited; }

    std::uint32_t word = 0;
  };

  // What an orienting axis may turn in this tick, 2^-32 turn.
  struct TurnRange {
    float low;
    float high;
  };
  struct Orienting {
    std::array<TurnRange, kMaxOrienting> range;
    std::array<float, kMaxOrienting> excess;         // found within it
    std::array<std::int32_t, kMaxOrienting> target;  // the offset that takes it away, not clamped
    kernel::StepAngles angle;
  };
  struct NotOrienting {};

  using Places = std::array<Located, kAxes>;
  // What a tick works on. A compiled-in machine keeps it in registers on the fast path.
  struct Work {
    Places at;
    kernel::Columns column;
    kernel::Excess excess;
    std::array<std::int32_t, kMaxCorrecting> target;  // what bounds act on: the offset wanted
    std::conditional_t<kOrients, Orienting, NotOrienting> turns;
  };

  // The state of a correcting axis; that of a loaded machine has been looked up once.
  AxisState& corrected(std::size_t correcting) {
    if constexpr (Machine::kCompiledIn) {
      return axis_[machine_.chain.correcting[correcting]];
    } else {
      return *corrected_[correcting];
    }
  }

  // compensator_tick.inl
  [[nodiscard]] std::int32_t followed_offset(const AxisState& s) const;
  template <class Visit>
  void for_each_axis(const Visit& visit) const;
  template <class Visit>
  void for_each_correcting(const Visit& visit) const;
  [[nodiscard]] bool ordinary() const;
  float advance_ramp(std::uint32_t& common);
  template <bool Turns>
  static bool within_reach(const AxisState& s, std::int64_t position);
  template <bool Turns>
  bool takes_fast_path(std::size_t axis, const AxisSample& sample, const Tables& set,
                       std::uint32_t& place) const;
  template <bool Turns>
  bool follow(std::size_t axis, const AxisSample& sample, const Tables& set, Located& at);
  bool follow_one(std::size_t axis, const AxisSample& sample, const Tables& set, Located& at);
  std::size_t follow_fast_path(const Input& in, const Tables& set, std::uint32_t status, Places& at,
                               Output& out);
  void keep_places(const Places& at, std::size_t count);
  bool find_excess(const Tables& set, Work& work, Float3& error_nm) const;
  bool find_kept_excess(const Tables& set, Work& work, Float3& error_nm) const;
  template <bool Ramps>
  bool put_out(std::size_t axis, AxisState& s, float excess, float ramp, std::uint32_t common,
               std::int32_t& target, Output& out);
  template <bool Ramps>
  std::uint32_t put_out_all(const Work& work, float ramp, std::uint32_t common, Output& out);

  // compensator_limited.inl
  bool put_out_limited(std::size_t axis, AxisState& s, float excess, std::int32_t target,
                       float ramp, std::uint32_t ramping, Output& out);
  template <class Visit>
  void for_each_offset(const Visit& visit);
  void tick_limited(std::uint32_t limited, std::uint32_t ended, float ramp, Output& out);
  template <class Unit>
  friend void detail::tick_limited(Unit& unit, std::uint32_t limited, std::uint32_t ended,
                                   float ramp, typename Unit::Output& out);

  // compensator_orienting.inl; nothing where the machine does not orient
  static Status check_orienting(const MachineChain& chain);
  void allow_turns(Work& work) const;
  void take_turns(const Tables& set, Work& work, Float3& error_nm) const;
  [[nodiscard]] float* excess_of(std::size_t axis);
  template <class Visit>
  void for_each_orienting(const Visit& visit);

  // compensator_exceptions.inl
  template <bool Fast>
  void take_request();
  template <bool Fast>
  void begin_change();
  void end_change();
  void forget_places();
  std::uint32_t take_sample(AxisState& s, const AxisSample& sample, std::int32_t least, bool turns);
  void follow_slowly(AxisState& s, std::int32_t least, bool turns) const;
  std::uint32_t place(const AxisState& s, const AxisLookup& lookup, const std::array<Knot, 2>* rows,
                      bool turns, Knot& mean, Located& at) const;
  template <class Visit>
  void for_axes_from(std::size_t first, const Visit& visit) const;
  void follow_slow_path(const Input& in, std::size_t first, const Tables* set);
  std::uint32_t put_out_slow_path(AxisState& s, float excess, float ramp, std::uint32_t status);
  void report(std::size_t axis, const AxisState& s, std::uint32_t status, std::uint32_t ramping,
              Output& out, NextTick& next);
  static std::uint32_t hold(AxisState& s);
  void let_go(std::size_t axis, float ramp, std::uint32_t ramping, Output& out);
  void finish_slow_path(std::uint32_t gate, float ramp, Output& out);
  void tick_slow_path(const Input& in, std::size_t first, float ramp, Output& out);
  template <class Unit>
  friend void detail::tick_slow_path(Unit& unit, const typename Unit::Input& in, std::size_t first,
                                     float ramp, typename Unit::Output& out);

  // compensator_background.inl
  [[gnu::cold]] void request(const Tables* tables);
  [[gnu::cold]] void take_machine();
  [[gnu::cold]] void apply_limits(std::size_t axis);
  [[gnu::cold]] void apply_directions();
  [[gnu::cold]] void apply_hysteresis();
  // The hysteresis of the settings, or wider: no offset of the tables in either buffer then turns a
  // direction.
  [[nodiscard, gnu::cold]] std::int32_t needed_hysteresis(std::size_t axis) const;
  [[nodiscard, gnu::cold]] std::uint32_t settings_checksum() const;
  [[nodiscard, gnu::cold]] bool settings_intact() const;
  [[gnu::cold]] Status open_spare(const Provenance& provenance);
  [[gnu::cold]] Status fold_into_spare(const RuntimeChain& chain, const TablesView& tables,
                                       const Vec3& tool_point, std::uint32_t image_crc);
  [[gnu::cold]] Status reject(const Status& status);
  template <class Value>
  static Span<const std::uint8_t> bytes_of(const Value& value) {
    return {reinterpret_cast<const std::uint8_t*>(&value),
            std::is_empty_v<Value> ? 0 : sizeof value};
  }
  [[gnu::cold]] static std::uint32_t checksum(const Tables& set);
  [[nodiscard]] bool activation_waits() const {
    return wanted_.load(std::memory_order_relaxed) != nullptr && pending();
  }
  [[nodiscard]] bool rotary(std::size_t axis) const {
    return machine_.chain.kind[axis] == JointKind::rotary;
  }

  // what the fast path needs comes first: short offsets are short instructions
  std::atomic<std::uint32_t> requested_{0};  // 1: wanted_ is to be read
  struct {
    std::int32_t target = -1;  // all ones where the offset is to be added to the position
    std::int32_t follow = 0;   // all ones where the direction is that of both
  } masks_;
  std::uint32_t guarded_axes_ = kNoAxes;  // slow path pending, bit per axis, or kNoAxes
  std::uint32_t limited_axes_ = 0;        // whose last status was not kValid alone, bit per axis
  Published<std::uint32_t> ticks_ = 0;
  Change now_{};
  Float3 error_nm_{};
  std::array<AxisState*, kMaxCorrecting> corrected_{};
  Work work_{};
  std::array<AxisState, kAxes> axis_{};
  std::array<Knot, kAxes> mean_{};  // rows in use until a direction is known

  std::atomic<const Tables*> wanted_{nullptr};  // to be in force
  const Tables* latest_ = nullptr;              // ever handed over
  std::uint32_t activations_ = 0;
  std::array<std::uint32_t, 2> activation_of_{};  // what a buffer was handed over as
  Ramp next_ramp_{};                              // of the next change
  std::uint32_t unknown_axes_ = 0;                // that have never had a valid position
  Published<std::uint32_t> ramps_ = 0;  // begun and come to rest: odd while one is under way
  Published<bool> ticks_wrapped_ = false;
  std::size_t spare_ = 0;  // index of the buffer that may be written
  bool staged_ = false;
  AtomicWord<> damaged_{0};
  FoldReport report_{};
  std::array<std::array<std::int32_t, kMaxAxes>, 2> reversal_nm_{};  // of both buffers
  std::uint32_t rejections_ = 0;
  Status last_rejection_{};
  Settings settings_{};
  Machine machine_{};
  std::array<StatusTally, kAxes> tally_{};

  // How far the scrub is: in the chain or, after that, in the tables.
  struct Scrub {
    const Tables* set = nullptr;
    std::uint32_t activations = 0;
    PiecewiseCrc read;
    bool tables = false;
  };
  Scrub scrub_{};
  std::uint32_t settings_crc_ = 0;
  std::uint32_t machine_crc_ = 0;
  std::array<Tables, 2> buffer_{};
};

}  // namespace volcomp

#include "comp/tick/compensator_background.inl"
#include "comp/tick/compensator_exceptions.inl"
#include "comp/tick/compensator_latch.inl"
#include "comp/tick/compensator_limited.inl"
#include "comp/tick/compensator_orienting.inl"
#include "comp/tick/compensator_tick.inl"
