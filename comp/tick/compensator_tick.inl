// The fast path: every sample is good, every axis inside its table. One straight run of
// instructions, nearly the same number each time.

namespace volcomp {

// Visits the axes with constant indices: what belongs to an axis has an address known beforehand
// or, in a compiled-in machine, stays in registers.
template <class Machine, std::size_t Knots, class Limiter>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::for_each_axis(const Visit& visit) const {
  kernel::visit_each(0, machine_.chain.axes, visit, std::make_index_sequence<kAxes>{});
}

template <class Machine, std::size_t Knots, class Limiter>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::for_each_correcting(
    const Visit& visit) const {
  kernel::visit_each(0, machine_.chain.correcting_count, visit,
                     std::make_index_sequence<kMaxCorrecting>{});
}

// Whether the axis can have come here since the last tick: from inside its table, if it is linear.
// −reach ≤ moved < reach, which nothing is while `reach` is 0.
template <class Machine, std::size_t Knots, class Limiter>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::within_reach(const AxisState& s,
                                                                       std::int64_t position) {
  const auto moved = static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(s.seen);
  if (Turns) return moved + s.reach < 2 * s.reach;
  const auto reach = static_cast<std::uint32_t>(s.reach);
  return static_cast<std::uint32_t>(moved) + reach < 2 * reach;
}

// The part of the offset that counts for the direction of a linear axis.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE std::int32_t Compensator<Machine, Knots, Limiter>::followed_offset(
    const AxisState& s) const {
  if (Machine::kCompiledIn && !directions_follow_offsets(machine_.chain)) return 0;
  return s.out.offset() & (Machine::kCompiledIn ? masks_.target : masks_.follow);
}

// A sample of the fast path is valid, referenced, no further from the last one than the axis can
// have moved, and inside the table: `place` is the distance from its first knot. Target mode adds
// the offset the drive will have applied.
template <class Machine, std::size_t Knots, class Limiter>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::takes_fast_path(
    std::size_t axis, const AxisSample& sample, const Tables& set, std::uint32_t& place) const {
  const AxisState& s = axis_[axis];
  const AxisLookup& lookup = set.lookup[axis];
  if (VOLCOMP_UNLIKELY(!sample.good())) return false;
  if (VOLCOMP_UNLIKELY(!within_reach<Turns>(s, sample.position))) return false;
  const std::int64_t r = distance(lookup, sample.position, s.out.offset() & masks_.target, Turns);
  place = static_cast<std::uint32_t>(r);
  return !VOLCOMP_UNLIKELY(outside(lookup, r, Turns, lookup.fast_path_travel));
}

template <class Machine, std::size_t Knots, class Limiter>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::follow(std::size_t axis,
                                                                 const AxisSample& sample,
                                                                 const Tables& set, Located& at) {
  std::uint32_t place = 0;
  if (VOLCOMP_UNLIKELY(!takes_fast_path<Turns>(axis, sample, set, place))) return false;
  AxisState& s = axis_[axis];
  s.seen = sample.position;
  const auto low = Turns ? static_cast<std::uint32_t>(sample.position >> 8)
                         : static_cast<std::uint32_t>(sample.position) +
                               static_cast<std::uint32_t>(followed_offset(s));
  const Direction d = s.direction.follow(low, s.hysteresis.get());
  locate(set.lookup[axis], place, Turns, set.rows[axis].data(), d, at);
  return true;
}

template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::follow_one(std::size_t axis,
                                                                     const AxisSample& sample,
                                                                     const Tables& set,
                                                                     Located& at) {
  return rotary(axis) ? follow<true>(axis, sample, set, at) : follow<false>(axis, sample, set, at);
}

// Returns how many axes, from the first one on, took the fast path. Reports on the way what holds
// unless a correction changes it.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE std::size_t Compensator<Machine, Knots, Limiter>::follow_fast_path(
    const Input& in, const Tables& set, std::uint32_t status, Places& at, Output& out) {
  std::size_t followed = 0;
  for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    if (followed != a || !follow_one(a, in.axis[a], set, at[a])) return;
    followed = a + 1;
    const bool corrects = machine_.chain.correcting_index[a] != kNotCorrecting;
    if (Machine::kCompiledIn && corrects)
      return;  // on a loaded machine storing is cheaper than branching
    out.status[a] = static_cast<std::uint16_t>(status);
    out.offset[a] = axis_[a].out.offset();
  });
  return followed;
}

// For the slow path, which goes on from here.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::keep_places(const Places& at,
                                                                      std::size_t count) {
  if constexpr (Machine::kCompiledIn) {
    for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
      if (a < count) work_.at[a] = at[a];
    });
  }
}

// The error in base, and what the correcting axes have to take away of it, nm or 2^-32 turn. False
// without authority.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::find_excess(const Tables& set, Work& work,
                                                                      Float3& error_nm) const {
  const RuntimeChain& chain = machine_.chain;
  if (chain.folded) {
    error_nm = kernel::folded_error(machine_, set, work.at);
  } else if constexpr (kOrients) {
    error_nm = kernel::recursive_error(machine_, set, work.at, work.column,
                                       kernel::KeepsAngles{work.turns.angle});
  } else {
    error_nm =
        kernel::recursive_error(machine_, set, work.at, work.column, kernel::KeepsNoAngles{});
  }
  if constexpr (kOrients) {
    Float3 left_nm = error_nm;
    if (chain.orienting_count != 0) take_turns(set, work, left_nm);
    return kernel::find_excess(machine_, set, work.column, left_nm, work.excess);
  }
  return kernel::find_excess(machine_, set, work.column, error_nm, work.excess);
}

// The same as one function in memory: for a loaded machine, whose indices are not known beforehand,
// for the slow path, and for touches.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] bool Compensator<Machine, Knots, Limiter>::find_kept_excess(
    const Tables& set, Work& work, Float3& error_nm) const {
  return find_excess(set, work, error_nm);
}

// No change of tables, no ramp, no axis that was limited or is not followed as usual.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::ordinary() const {
  return (requested_.load(std::memory_order_relaxed) | now_.ramp.next() | guarded_axes_ |
          limited_axes_) == 0;
}

// Takes a request; one step of the ramp. Returns its factor.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE float Compensator<Machine, Knots, Limiter>::advance_ramp(std::uint32_t& common) {
  float ramp = 1.0F;
  if (requested_.load(std::memory_order_relaxed) != 0) {
    take_request<true>();
    ramp = now_.ramp.begin();
    common |= kRamping;
    if (!now_.ramp.running()) end_change();
  } else if (!now_.ramp.at_rest()) {
    ramp = now_.ramp.advance();
    if (!now_.ramp.running()) end_change();
    if (now_.ramp.at_rest()) {
      ramps_.set(ramps_.own() + 1U);
    } else {
      common |= kRamping;
    }
  }
  return ramp;
}

// Clamp, ramp, round, limit: the offset that takes `excess` away. False where the bounds act, and
// nothing has happened: numbers beyond the limit, or none, end up beyond everything that is
// reached.
template <class Machine, std::size_t Knots, class Limiter>
template <bool Ramps>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::put_out(std::size_t axis, AxisState& s,
                                                                  float excess, float ramp,
                                                                  std::uint32_t common,
                                                                  std::int32_t& target,
                                                                  Output& out) {
  if (VOLCOMP_UNLIKELY(Ramps && exceeds(excess, s.limit))) return false;
  target = round_half_even(Ramps ? s.ramp_from - ramp * (excess + s.ramp_from) : -excess);
  if (VOLCOMP_UNLIKELY(!s.out.reach(target))) return false;
  out.offset[axis] = s.out.offset();
  out.status[axis] = static_cast<std::uint16_t>(common);
  return true;
}

// Returns the axes that the bounds act on, bit per axis; what they should put out is kept.
template <class Machine, std::size_t Knots, class Limiter>
template <bool Ramps>
VOLCOMP_INLINE std::uint32_t Compensator<Machine, Knots, Limiter>::put_out_all(const Work& work,
                                                                               float ramp,
                                                                               std::uint32_t common,
                                                                               Output& out) {
  std::uint32_t limited = 0;
  for_each_correcting([&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    const std::size_t a = machine_.chain.correcting[c];
    std::int32_t target = 0;
    if (put_out<Ramps>(a, corrected(c), work.excess[c], ramp, common, target, out)) return;
    limited |= 1U << a;
    work_.target[c] = target;
    if (Machine::kCompiledIn) work_.excess[c] = work.excess[c];
  });
  if constexpr (kOrients) {
    for_each_orienting([&](AxisState& s, std::size_t o) VOLCOMP_INLINE_LAMBDA {
      const std::size_t a = machine_.chain.orienting[o];
      std::int32_t& target = work_.turns.target[o];
      if (!put_out<Ramps>(a, s, work.turns.excess[o], ramp, common, target, out))
        limited |= 1U << a;
    });
  }
  return limited;
}

template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::tick(const Input& in, Output& out) {
  const std::uint32_t ticks = ticks_.own() + 1U;
  ticks_.set(ticks);
  if (VOLCOMP_UNLIKELY(ticks == 0)) ticks_wrapped_.set(true);
  std::uint32_t common = kValid;
  float ramp = 1.0F;
  std::uint32_t was_limited = 0;
  if (VOLCOMP_UNLIKELY(!ordinary())) {
    ramp = advance_ramp(common);
    if (guarded_axes_ != 0 || now_.active.own() == nullptr)
      return detail::tick_slow_path(*this, in, 0, ramp, out);
    was_limited = limited_axes_;
    limited_axes_ = 0;
  }
  const Tables& set = *now_.active.own();
  // Filled step by step, and all of it before it is read.
  Work local;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  Work& w = Machine::kCompiledIn ? local : work_;
  const std::size_t followed = follow_fast_path(in, set, common, w.at, out);
  if (VOLCOMP_UNLIKELY(followed != machine_.chain.axes)) {
    keep_places(w.at, followed);
    return detail::tick_slow_path(*this, in, followed, ramp, out);
  }
  allow_turns(w);
  const bool possible = Machine::kCompiledIn ? find_excess(set, w, error_nm_)
                                             : find_kept_excess(set, work_, error_nm_);
  if (VOLCOMP_UNLIKELY(!possible)) {
    keep_places(w.at, followed);
    return detail::tick_slow_path(*this, in, followed, ramp, out);
  }
  const std::uint32_t limited = VOLCOMP_UNLIKELY(common != kValid)
                                    ? put_out_all<true>(w, ramp, common, out)
                                    : put_out_all<false>(w, ramp, common, out);
  if (VOLCOMP_UNLIKELY((limited | was_limited) != 0))
    detail::tick_limited(*this, limited, was_limited & ~limited, ramp, out);
}

}  // namespace volcomp
