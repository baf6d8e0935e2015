// The slow path of a tick: changes of tables, ramps, samples that are late, lost or implausible,
// axes that are not referenced, positions beyond a table. Functions of their own, so that the fast
// path stays one straight run; only what belongs to an exchange of tables is inlined, because that
// tick counts, too.

namespace volcomp {

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::take_request() {
  requested_.store(0, std::memory_order_relaxed);
  // Either this tick reads the latest pointer, or the flag is set again after it: request(). Since
  // nothing is staged while a request waits, the release of the flag that tick() saw covers the
  // tables of any pointer that is read here, and the fence acquires it.
  std::atomic_thread_fence(std::memory_order_seq_cst);
  const Tables* const wanted = wanted_.load(kAfterFence);
  begin_change();
  now_.ramp = next_ramp_;
  now_.active.release(wanted);  // the background may then write into those that were active
}

// Whatever changes, the output goes from where it is to where it should be along the ramp. One that
// is under way goes over into the next. Where fewer axes correct, the first axis has its turn more
// than once: storing is cheaper than branching.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::begin_change() {
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    corrected(c).ramp_from = static_cast<float>(corrected(c).output);
  for_each_orienting([](AxisState& s, std::size_t)
                         VOLCOMP_INLINE_LAMBDA { s.ramp_from = static_cast<float>(s.output); });
  ramps_.set(ramps_.own() | 1U);
}

// At the end of the ramp nothing of its start is left: from + 1 · (x − from) is exactly x where
// `from` is 0.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::end_change() {
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    corrected(c).ramp_from = 0.0F;
  for_each_orienting([](AxisState& s, std::size_t) VOLCOMP_INLINE_LAMBDA { s.ramp_from = 0.0F; });
}

// A rotary position may wrap: int64 is a whole number of turns.
constexpr std::int64_t held_in_range(std::int64_t position, bool turns) {
  return turns ? position : clamp_position(position);
}

// Whether every axis has reported at last.
template <class Machine, std::size_t Knots>
bool Compensator<Machine, Knots>::all_known(const Input& in) {
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    AxisState& s = axis_[a];
    if (s.known || !in.axis[a].valid) continue;
    s.known = true;
    s.seen = held_in_range(in.axis[a].position, rotary(a));
    --unknown_axes_;
  }
  return unknown_axes_ == 0;
}

// Takes a first, lost, implausible, returning, unreferenced or absurdly large sample, or a good
// one. Returns the status bits it raises.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] std::uint32_t Compensator<Machine, Knots>::take_sample(std::size_t axis,
                                                                         const AxisSample& sample) {
  AxisState& s = axis_[axis];
  const bool turns = rotary(axis);
  if (s.steady) s.position = s.seen;
  const std::int64_t position = held_in_range(sample.position, turns);
  const std::uint64_t moved =
      static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(s.seen);
  const bool plausible = !s.known || moved + s.most_step <= 2 * s.most_step;
  std::uint32_t status = sample.homed ? 0U : std::uint32_t{kNotHomed};
  s.steady = sample.valid && plausible;
  if (s.steady && !s.known) --unknown_axes_;
  s.known = s.known || s.steady;
  if (sample.valid) s.seen = position;
  s.reach = 0;
  if (s.steady) {
    s.stale_ticks = 0;
    s.position = position;
    // Until it is known, the position alone shows it, by the hysteresis of the settings: what ramps
    // an offset in would show another one than before a restart, and nothing can chase itself yet.
    const auto low = static_cast<std::uint32_t>(turns ? position >> 8 : position);
    const auto offset = [&] { return turns ? 0U : static_cast<std::uint32_t>(followed_offset(s)); };
    const std::int32_t hysteresis = s.hysteresis.get();
    if (s.direction.direction() != Direction::unknown) {
      s.direction.follow(low + offset(), hysteresis);
    } else {
      const std::int32_t least = settings_.axis[axis].hysteresis;
      const Direction now = s.direction.update(low, least);
      const std::int32_t wider = now == Direction::forward ? hysteresis - least : 0;
      if (now != Direction::unknown)
        s.direction.shift(offset() - static_cast<std::uint32_t>(wider));
    }
    return status;
  }
  status |= kStale;
  if (sample.valid) status |= kImplausible;
  if (s.stale_ticks >= settings_.stale_drop_ticks) status |= kDropped;
  if (s.stale_ticks < UINT16_MAX) ++s.stale_ticks;
  return status;
}

// Where the axis stands in its table, held at the ends.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] void Compensator<Machine, Knots>::place(std::size_t axis, const Tables& set,
                                                          Located& at, std::uint32_t& status) {
  AxisState& s = axis_[axis];
  const bool turns = rotary(axis);
  std::int64_t r = distance(set.lookup[axis], s.position, s.output & masks_.target, turns);
  const RangeState range = hold_inside(set.lookup[axis], turns, r);
  if (range != RangeState::inside) status |= kOutOfRange;
  if (range == RangeState::far_outside) status |= kFarOutOfRange;
  const Direction direction = s.direction.direction();
  if (direction == Direction::unknown) status |= kDirectionUnknown;
  locate_any(set.lookup[axis], static_cast<std::uint32_t>(r), turns, set.rows[axis].data(),
             direction, s.mean, at);
}

// Follows all axes, whatever they show. False until every axis has reported.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] bool Compensator<Machine, Knots>::follow_slow_path(const Input& in) {
  if (unknown_axes_ != 0 && !all_known(in)) return false;
  const Tables& set = *now_.active.own();
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    AxisState& s = axis_[a];
    if (follow_one(a, in.axis[a], set, work_.at[a])) continue;
    std::uint32_t status = take_sample(a, in.axis[a]);
    place(a, set, work_.at[a], status);
    constexpr std::uint32_t kSlowPathNext = kStale | kOutOfRange | kDirectionUnknown;
    if ((status & kSlowPathNext) == 0) s.reach = s.fast_path_step;
    s.exception = static_cast<std::uint16_t>(status);
    guarded_axes_ |= 1U << a;
  }
  return true;
}

// Clamp, ramp, round and slew with everything that can be going on: hold, gating to 0 and the soft
// way back.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] void Compensator<Machine, Knots>::put_out_slow_path(AxisState& s, float excess,
                                                                      float ramp,
                                                                      std::uint32_t& status) {
  // Accepted tables do not lead to what is not finite: they, or the machine, have changed in
  // memory.
  if (VOLCOMP_UNLIKELY(!Magnitude::finite(excess))) status |= kClamped | kTableDamaged;
  const bool off = (status & (kNotHomed | kDropped | kNoTables | kTableDamaged)) != 0;
  const bool held = !off && (status & (kStale | kNoAuthority)) != 0;
  // A drive may have started with more than the limit, and the limit may have become smaller.
  s.ramp_from = s.limit.within(s.ramp_from);
  const float wanted = off ? 0.0F : -excess;
  if (exceeds(wanted, s.limit)) status |= kClamped;
  float x = s.ramp_from + ramp * (s.limit.within(wanted) - s.ramp_from);
  if (held) x = s.limit.within(static_cast<float>(s.output));
  const std::int32_t rounded = round_half_even(x);

  s.soft = s.soft || (off && (status & kNoTables) == 0);
  const std::int32_t rate = s.soft ? s.soft_rate : s.rate;
  const bool hit = further(rounded, s.output, rate);
  const std::int32_t step = rounded < s.output ? -rate : rate;
  s.output = hit ? s.output + step : rounded;
  if (hit && !s.soft) status |= kRateLimited;
  if (exceeds(static_cast<float>(s.output), s.limit)) status |= kClamped | kRateLimited;
  if (!hit && !off) s.soft = false;
  const std::int32_t size = s.output < 0 ? -s.output : s.output;
  if (size > s.largest.own()) s.largest.set(size);
}

// Counts what began and stores the status word. Returns false if the next output of this axis has
// to take the slow path, too.
template <class Machine, std::size_t Knots>
bool Compensator<Machine, Knots>::count_changes(std::size_t axis, std::uint32_t status) {
  AxisState& s = axis_[axis];
  const std::size_t c = machine_.chain.correcting_index[axis];
  const bool corrects = c != kNotCorrecting;
  const FastPathBits last = corrects ? tally_.last(c) : fast_path_bits(kValid);
  const std::uint32_t before = s.status == 0 ? fast_path_status(last) : std::uint32_t{s.status};
  std::uint32_t began = status & ~before;
  while (began != 0) {  // at most kStatusBits times
    const auto bit = static_cast<std::size_t>(__builtin_ctz(began));
    Published<std::uint16_t>& count = began_[axis][bit];
    if (count.own() < UINT16_MAX) count.set(static_cast<std::uint16_t>(count.own() + 1U));
    began &= began - 1U;
  }
  const FastPathBits bits = fast_path_bits(status);
  bool fast = status == fast_path_status(bits);
  if constexpr (kOrients) fast = fast && (corrects || status == kValid);  // no tally
  if (corrects) tally_.resume(c, bits);
  s.status = static_cast<std::uint16_t>(fast ? 0U : status);
  return fast && !s.soft && !beyond_limit(s);
}

// Outputs and reports of all axes in a tick on the slow path. `gate`: what applies to every
// correcting axis.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] void Compensator<Machine, Knots>::finish_slow_path(std::uint32_t gate, float ramp,
                                                                     Output& out) {
  const RuntimeChain& chain = machine_.chain;
  const bool damaged = damaged_.load(std::memory_order_relaxed) != 0;
  const std::uint32_t ramping = now_.ramp.at_rest() ? 0U : std::uint32_t{kRamping};
  guarded_axes_ = 0;
  for (std::size_t a = 0; a < chain.axes; ++a) {
    std::uint32_t status = axis_[a].exception;
    axis_[a].exception = 0;
    if (const float* const excess = excess_of(a); excess != nullptr) {
      status |= gate;
      put_out_slow_path(axis_[a], *excess, ramp, status);
    }
    if (damaged) status |= kTableDamaged;
    if ((status & ~std::uint32_t{kDirectionUnknown}) == 0) status |= kValid;
    if (!count_changes(a, status)) guarded_axes_ |= 1U << a;
    out.offset[a] = axis_[a].output;
    out.status[a] = static_cast<std::uint16_t>(status | ramping);
  }
}

// A tick without tables, or before every axis has reported. Returns what applies to all correcting
// axes: off or held.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] std::uint32_t Compensator<Machine, Knots>::idle(const Input& in) {
  for (std::size_t a = 0; a < machine_.chain.axes; ++a)
    axis_[a].exception = static_cast<std::uint16_t>(take_sample(a, in.axis[a]));
  work_.excess = {};
  if constexpr (kOrients) work_.turns.excess = {};
  return now_.active.own() != nullptr ? kStale : kNoTables;
}

// A tick from its beginning on, for whatever can happen.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::tick_slow_path(const Input& in, float ramp,
                                                                Output& out) {
  std::uint32_t gate = 0;
  if (now_.active.own() == nullptr || !follow_slow_path(in)) {
    gate = idle(in);
  } else {
    allow_turns(work_);
    if (!find_kept_excess(*now_.active.own(), work_, error_nm_)) gate = kNoAuthority;
  }
  finish_slow_path(gate, ramp, out);
}

template <class Unit>
[[gnu::noinline]] static void detail::tick_slow_path(Unit& unit, const typename Unit::Input& in,
                                                     float ramp, typename Unit::Output& out) {
  unit.tick_slow_path(in, ramp, out);
}

}  // namespace volcomp
