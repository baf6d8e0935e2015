// The slow path of a tick: changes of tables, ramps, samples that are late, lost or implausible,
// axes that are not referenced, positions beyond a table. Functions of their own, so that the fast
// path stays one straight run; only what belongs to an exchange of tables is inlined, because that
// tick counts, too.

namespace volcomp {

template <class Machine, std::size_t Knots, class Limiter>
template <bool Fast>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::take_request() {
  requested_.store(0, std::memory_order_relaxed);
  // Either this tick reads the latest pointer, or the flag is set again after it: request(). Since
  // nothing is staged while a request waits, the release of the flag that tick() saw covers the
  // tables of any pointer that is read here, and the fence acquires it.
  std::atomic_thread_fence(std::memory_order_seq_cst);
  const Tables* const wanted = wanted_.load(kAfterFence);
  begin_change<Fast>();
  now_.ramp = next_ramp_;
  now_.active.release(wanted);  // the background may then write into those that were active
}

// Whatever changes, the output goes from where it is, or comes to rest, to where it should be along
// the ramp. One that is under way goes over into the next. Where fewer axes correct, the first axis
// has its turn more than once: storing is cheaper than branching. `Fast`: in a tick; for size in
// the background.
template <class Machine, std::size_t Knots, class Limiter>
template <bool Fast>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::begin_change() {
  const auto begin = [](AxisState& s) VOLCOMP_INLINE_LAMBDA {
    s.ramp_from = static_cast<float>(s.out.standstill());
  };
  if constexpr (Fast) {
    VOLCOMP_UNROLL
    for (std::size_t c = 0; c < kMaxCorrecting; ++c)
      begin(corrected(c));
  } else {
    VOLCOMP_LOOP
    for (std::size_t c = 0; c < kMaxCorrecting; ++c)
      begin(corrected(c));
  }
  for_each_orienting([&](AxisState& s, std::size_t) VOLCOMP_INLINE_LAMBDA { begin(s); });
  ramps_.set(ramps_.own() | 1U);
}

// At the end of the ramp nothing of its start is left: from + 1 · (x − from) is exactly x where
// `from` is 0.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::end_change() {
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    corrected(c).ramp_from = 0.0F;
  for_each_orienting([](AxisState& s, std::size_t) VOLCOMP_INLINE_LAMBDA { s.ramp_from = 0.0F; });
}

// A rotary position may wrap: int64 is a whole number of turns.
constexpr std::int64_t held_in_range(std::int64_t position, bool turns) {
  return turns ? position : clamp_position(position);
}

// Takes a first, lost, implausible, returning, unreferenced or absurdly large sample, or a good
// one. Returns the status bits it raises.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE std::uint32_t Compensator<Machine, Knots, Limiter>::take_sample(
    AxisState& s, const AxisSample& sample, std::int32_t least, bool turns) {
  std::uint32_t status = sample.homed ? 0U : std::uint32_t{kNotHomed};
  if (s.steady) s.position = s.seen;
  bool good = sample.valid;
  if (good) {
    const std::int64_t position = held_in_range(sample.position, turns);
    const std::uint64_t moved =
        static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(s.seen);
    s.seen = position;
    if (!s.known) {
      s.known = true;
      --unknown_axes_;
    } else if (moved + s.most_step > 2 * s.most_step) {
      good = false;
      status |= kImplausible;
    }
  }
  s.steady = good;
  s.reach = 0;
  if (good) {
    s.stale_ticks = 0;
    s.position = s.seen;
    follow_slowly(s, least, turns);
    return status;
  }
  if (s.stale_ticks >= settings_.stale_drop_ticks) status |= kDropped;
  if (s.stale_ticks < UINT16_MAX) ++s.stale_ticks;
  return status | kStale;
}

// The direction. Until it is known, the position alone shows it, by the hysteresis of the settings,
// `least`: what ramps an offset in would show another one than before a restart, and nothing can
// chase itself yet.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::follow_slowly(AxisState& s,
                                                                        std::int32_t least,
                                                                        bool turns) const {
  const auto low = static_cast<std::uint32_t>(turns ? s.position >> 8 : s.position);
  const auto offset = turns ? 0U : static_cast<std::uint32_t>(followed_offset(s));
  const std::int32_t hysteresis = s.hysteresis.get();
  if (s.direction.direction() != Direction::unknown) {
    s.direction.follow(low + offset, hysteresis);
    return;
  }
  const Direction now = s.direction.update(low, least);
  const std::int32_t wider = now == Direction::forward ? hysteresis - least : 0;
  if (now != Direction::unknown) s.direction.shift(offset - static_cast<std::uint32_t>(wider));
}

// Where the axis stands in its table, held at the ends. Returns the status bits it raises.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE std::uint32_t Compensator<Machine, Knots, Limiter>::place(
    const AxisState& s, const AxisLookup& lookup, const std::array<Knot, 2>* rows, bool turns,
    Knot& mean, Located& at) const {
  std::uint32_t status = 0;
  std::int64_t r = distance(lookup, s.position, s.out.offset() & masks_.target, turns);
  if (outside(lookup, r, turns, lookup.travel))
    status = hold_inside(lookup, r) ? kOutOfRange | kFarOutOfRange : kOutOfRange;
  const Direction direction = s.direction.direction();
  if (direction == Direction::unknown) status |= kDirectionUnknown;
  locate_any(lookup, static_cast<std::uint32_t>(r), turns, rows, direction, mean, at);
  return status;
}

// Visits the axes from the first one on; those of a compiled-in machine with constant indices.
template <class Machine, std::size_t Knots, class Limiter>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::for_axes_from(std::size_t first,
                                                                        const Visit& visit) const {
  if constexpr (Machine::kCompiledIn) {
    kernel::visit_each(first, machine_.chain.axes, visit, std::make_index_sequence<kAxes>{});
  } else {
    VOLCOMP_LOOP
    for (std::size_t a = first; a < machine_.chain.axes; ++a)
      visit(a);
  }
}

// Follows the axes from the first one on that the fast path did not take, whatever they show;
// without tables as far as their samples go.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] void Compensator<Machine, Knots, Limiter>::follow_slow_path(const Input& in,
                                                                              std::size_t first,
                                                                              const Tables* set) {
  for_axes_from(first, [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    const AxisSample& sample = in.axis[a];
    AxisState& s = axis_[a];
    if (set != nullptr && follow_one(a, sample, *set, work_.at[a])) return;
    std::uint32_t status = take_sample(s, sample, settings_.axis[a].hysteresis, rotary(a));
    if (set != nullptr) {
      status |= place(s, set->lookup[a], set->rows[a].data(), rotary(a), mean_[a], work_.at[a]);
      constexpr std::uint32_t kSlowPathNext = kStale | kOutOfRange | kDirectionUnknown;
      if ((status & kSlowPathNext) == 0) s.reach = s.fast_path_step;
    }
    s.exception = static_cast<std::uint16_t>(status);
  });
}

// Before every axis has reported, nothing is said of where the others stand.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] void Compensator<Machine, Knots, Limiter>::forget_places() {
  constexpr std::uint32_t kOfPlace = kOutOfRange | kFarOutOfRange | kDirectionUnknown;
  VOLCOMP_LOOP
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    AxisState& s = axis_[a];
    s.exception = static_cast<std::uint16_t>(s.exception & ~kOfPlace);
  }
}

// Clamp, ramp, round and limit with everything that can be going on: hold, gating to 0 and the soft
// way back. Takes the status of the axis and returns it with what the correction adds, kSettling
// included.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE std::uint32_t Compensator<Machine, Knots, Limiter>::put_out_slow_path(
    AxisState& s, float excess, float ramp, std::uint32_t status) {
  // Accepted tables do not lead to what is not finite: they, or the machine, have changed in
  // memory.
  if (VOLCOMP_UNLIKELY(!Magnitude::finite(excess))) status |= kClamped | kTableDamaged;
  const bool off = (status & (kNotHomed | kDropped | kNoTables | kTableDamaged)) != 0;
  const bool held = !off && (status & (kStale | kNoAuthority)) != 0;
  // A drive may have started with more than the limit, and the limit may have become smaller.
  if (exceeds(s.ramp_from, s.limit)) s.ramp_from = s.limit.signed_like(s.ramp_from);
  float wanted = off ? 0.0F : -excess;
  if (exceeds(wanted, s.limit)) {
    status |= kClamped;
    wanted = s.limit.signed_like(wanted);
  }
  s.soft = s.soft || (off && (status & kNoTables) == 0);
  std::uint32_t limited = 0;
  if (VOLCOMP_UNLIKELY(held)) {
    limited = hold(s);
  } else {
    const std::int32_t target = round_half_even(s.ramp_from + ramp * (wanted - s.ramp_from));
    limited = s.soft ? s.out.follow_softly(target) : s.out.follow(target);
  }
  if (limited == 0 && !off) s.soft = false;
  if (s.soft) limited &= kSettling;
  if (VOLCOMP_UNLIKELY((limited & kSettling) != 0)) limited |= kClamped | kRateLimited;
  return status | limited;
}

// The last offset, or the limit if that has become smaller.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] std::uint32_t Compensator<Machine, Knots, Limiter>::hold(AxisState& s) {
  const auto now = static_cast<float>(s.out.offset());
  if (!exceeds(now, s.limit)) return s.out.hold();
  const std::int32_t target = round_half_even(s.limit.signed_like(now));
  return s.soft ? s.out.follow_softly(target) : s.out.follow(target);
}

// An axis whose excess is not finite on the fast path.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] void Compensator<Machine, Knots, Limiter>::let_go(std::size_t axis, float ramp,
                                                                    std::uint32_t ramping,
                                                                    Output& out) {
  AxisState& s = axis_[axis];
  s.soft = true;
  const float x = s.ramp_from + ramp * (0.0F - s.ramp_from);
  std::uint32_t status = s.out.follow_softly(round_half_even(x)) & kSettling;
  if (status != 0) status |= kRateLimited;
  NextTick next;
  report(axis, s, status | kClamped | kTableDamaged, ramping, out, next);
  guarded_axes_ |= next.guarded();
  limited_axes_ |= next.limited();
}

// Counts what began and decides which path the next tick takes. A status without a bit is valid,
// also while no direction is known.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::report(std::size_t axis,
                                                                 const AxisState& s,
                                                                 std::uint32_t status,
                                                                 std::uint32_t ramping, Output& out,
                                                                 NextTick& next) {
  if ((status & ~std::uint32_t{kDirectionUnknown}) == 0) status |= kValid;
  const std::uint32_t bit = 1U << axis;
  if (status != kValid) next.word |= bit << NextTick::kLimited;
  if ((status & ~kOrdinaryStatus) != 0 || s.soft) next.word |= bit;
  status &= ~kSettling;
  out.offset[axis] = s.out.offset();
  out.status[axis] = static_cast<std::uint16_t>(status | ramping);
  tally_[axis].enter(status);
}

// Outputs and reports of all axes in a tick on the slow path. `gate`: what applies to every
// correcting axis.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] void Compensator<Machine, Knots, Limiter>::finish_slow_path(std::uint32_t gate,
                                                                              float ramp,
                                                                              Output& out) {
  const std::uint32_t damaged =
      damaged_.load(std::memory_order_relaxed) != 0 ? std::uint32_t{kTableDamaged} : 0U;
  const std::uint32_t ramping = now_.ramp.at_rest() ? 0U : std::uint32_t{kRamping};
  NextTick next;
  for_axes_from(0, [&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    AxisState& s = axis_[a];
    std::uint32_t status = s.exception;
    s.exception = 0;
    if (const float* const excess = excess_of(a); excess != nullptr)
      status = put_out_slow_path(s, *excess, ramp, status | gate);
    report(a, s, status | damaged, ramping, out, next);
  });
  guarded_axes_ = next.guarded() | (now_.active.own() != nullptr ? 0U : kNoAxes);
  limited_axes_ = next.limited();
}

// A tick from the first axis on that the fast path did not take, for whatever can happen. Without
// tables, and before every axis has reported, all correcting axes are off or held.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::tick_slow_path(const Input& in,
                                                                         std::size_t first,
                                                                         float ramp, Output& out) {
  const Tables* set = now_.active.own();
  std::uint32_t gate = set != nullptr ? 0U : std::uint32_t{kNoTables};
  follow_slow_path(in, first, set);
  if (set != nullptr && VOLCOMP_UNLIKELY(unknown_axes_ != 0)) {
    forget_places();
    set = nullptr;
    gate = kStale;
  }
  if (set == nullptr) {
    work_.excess = {};
    if constexpr (kOrients) work_.turns.excess = {};
  } else {
    allow_turns(work_);
    if (!find_kept_excess(*set, work_, error_nm_)) gate = kNoAuthority;
  }
  finish_slow_path(gate, ramp, out);
}

template <class Unit>
[[gnu::noinline]] static void detail::tick_slow_path(Unit& unit, const typename Unit::Input& in,
                                                     std::size_t first, float ramp,
                                                     typename Unit::Output& out) {
  unit.tick_slow_path(in, first, ramp, out);
}

}  // namespace volcomp
