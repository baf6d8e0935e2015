// The fast path: every sample is good, every axis inside its table. One straight run of
// instructions, nearly the same number each time.

namespace volcomp {

// Visits the axes with constant indices: what belongs to an axis has an address known beforehand
// or, in a compiled-in machine, stays in registers.
template <class Machine, std::size_t Knots>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots>::for_each_axis(const Visit& visit) const {
  kernel::visit_each(0, machine_.chain.axes, visit, std::make_index_sequence<kAxes>{});
}

template <class Machine, std::size_t Knots>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots>::for_each_correcting(const Visit& visit) const {
  kernel::visit_each(0, machine_.chain.correcting_count, visit,
                     std::make_index_sequence<kMaxCorrecting>{});
}

// Whether the axis can have come here since the last tick: from inside its table, if it is linear.
// −reach ≤ moved < reach, which nothing is while `reach` is 0.
template <class Machine, std::size_t Knots>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::within_reach(const AxisState& s,
                                                              std::int64_t position) {
  const auto moved = static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(s.seen);
  if (Turns) return moved + s.reach < 2 * s.reach;
  const auto reach = static_cast<std::uint32_t>(s.reach);
  return static_cast<std::uint32_t>(moved) + reach < 2 * reach;
}

// The part of the offset that counts for the direction of a linear axis.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE std::int32_t Compensator<Machine, Knots>::followed_offset(const AxisState& s) const {
  if (Machine::kCompiledIn && !directions_follow_offsets(machine_.chain)) return 0;
  return s.output & (Machine::kCompiledIn ? masks_.target : masks_.follow);
}

// A sample of the fast path is valid, referenced, no further from the last one than the axis can
// have moved, and inside the table: `place` is the distance from its first knot. Target mode adds
// the offset the drive will have applied.
template <class Machine, std::size_t Knots>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::takes_fast_path(std::size_t axis,
                                                                 const AxisSample& sample,
                                                                 const Tables& set,
                                                                 std::uint32_t& place) const {
  const AxisState& s = axis_[axis];
  const AxisLookup& lookup = set.lookup[axis];
  if (VOLCOMP_UNLIKELY(!sample.good())) return false;
  if (VOLCOMP_UNLIKELY(!within_reach<Turns>(s, sample.position))) return false;
  const std::int64_t r = distance(lookup, sample.position, s.output & masks_.target, Turns);
  place = static_cast<std::uint32_t>(r);
  return !VOLCOMP_UNLIKELY(outside(lookup, r, Turns, lookup.fast_path_travel));
}

template <class Machine, std::size_t Knots>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::follow(std::size_t axis, const AxisSample& sample,
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

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::follow_one(std::size_t axis,
                                                            const AxisSample& sample,
                                                            const Tables& set, Located& at) {
  return rotary(axis) ? follow<true>(axis, sample, set, at) : follow<false>(axis, sample, set, at);
}

// Returns false at the first axis that needs the slow path. follow_slow_path() then follows all
// once more: for those that came before it nothing changes, they stand where they stood. Reports on
// the way what holds unless a correction changes it.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::follow_fast_path(const Input& in,
                                                                  const Tables& set,
                                                                  std::uint32_t status, Places& at,
                                                                  Output& out) {
  bool fast = true;
  for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    fast = fast && follow_one(a, in.axis[a], set, at[a]);
    const bool corrects = machine_.chain.correcting_index[a] != kNotCorrecting;
    if (Machine::kCompiledIn && corrects)
      return;  // on a loaded machine storing is cheaper than branching
    out.status[a] = static_cast<std::uint16_t>(status);
    out.offset[a] = axis_[a].output;
  });
  return fast;
}

// The error in base, and what the correcting axes have to take away of it, nm or 2^-32 turn. False
// without authority.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::find_excess(const Tables& set, Work& work,
                                                             Float3& error_nm) const {
  const RuntimeChain& chain = machine_.chain;
  if (chain.folded) {
    error_nm = kernel::folded_error(machine_, set, work.at);
    work.excess = chain.inverse.form == InverseForm::aligned
                      ? kernel::aligned_excess(chain.inverse, error_nm)
                      : kernel::constant_excess(set, error_nm);
    return true;
  }
  error_nm = kernel::recursive_error(machine_, set, work.at, work.column);
  if constexpr (kOrients) {
    Float3 left_nm = error_nm;
    if (chain.orienting_count != 0) take_turns(set, work, left_nm);
    return kernel::varying_excess(machine_, work.column, left_nm, work.excess);
  }
  return kernel::varying_excess(machine_, work.column, error_nm, work.excess);
}

// The same as one function in memory: for a loaded machine, whose indices are not known beforehand,
// for the slow path, and for touches.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] bool Compensator<Machine, Knots>::find_kept_excess(const Tables& set, Work& work,
                                                                     Float3& error_nm) const {
  return find_excess(set, work, error_nm);
}

// Clamp, ramp, round, slew: the offset that takes `excess` away. `changed`: status bits that are
// not as in kAllValid.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::put_out(std::size_t correcting, float excess,
                                                         float ramp, std::uint32_t common,
                                                         FastPathBits& changed, Output& out) {
  const std::size_t a = machine_.chain.correcting[correcting];
  AxisState& s = corrected(correcting);
  std::uint32_t status = common;
  if (exceeds(excess, s.limit)) {
    excess = s.limit.signed_like(excess);
    status ^= kValid | kClamped;
    changed |= bits_of_axis(correcting, fast_path_bits(kValid | kClamped));
  }
  std::int32_t output = round_half_even(s.ramp_from - ramp * (excess + s.ramp_from));
  if (further(output, s.output, s.rate)) {
    output = output < s.output ? s.output - s.rate : s.output + s.rate;
    status = (status & ~std::uint32_t{kValid}) + kRateLimited;
    changed |= bits_of_axis(correcting, fast_path_bits(kValid | kRateLimited));
  }
  s.output = output;
  if (VOLCOMP_UNLIKELY(further(output, 0, s.largest.own())))
    s.largest.set(output < 0 ? -output : output);
  out.offset[a] = output;
  out.status[a] = static_cast<std::uint16_t>(status);
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::tick(const Input& in, Output& out) {
  ticks_.set(ticks_.own() + 1U);
  if (VOLCOMP_UNLIKELY(ticks_.own() == 0)) ticks_wrapped_.set(true);
  std::uint32_t common = kValid;
  float ramp = 1.0F;
  if (VOLCOMP_UNLIKELY(requested_.load(std::memory_order_relaxed) != 0)) {
    take_request();
    ramp = now_.ramp.begin();
    common |= kRamping;
    if (!now_.ramp.running()) end_change();
  } else if (VOLCOMP_UNLIKELY(!now_.ramp.at_rest())) {
    ramp = now_.ramp.advance();
    if (!now_.ramp.running()) end_change();
    if (now_.ramp.at_rest()) {
      ramps_.set(ramps_.own() + 1U);
    } else {
      common |= kRamping;
    }
  }
  const Tables* const set = now_.active.own();
  // Filled step by step, and all of it before it is read.
  Work local;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  Work& w = Machine::kCompiledIn ? local : work_;
  if (VOLCOMP_UNLIKELY(set == nullptr || guarded_axes_ != 0) ||
      !follow_fast_path(in, *set, common, w.at, out))
    return detail::tick_slow_path(*this, in, ramp, out);
  allow_turns(w);
  const bool possible = Machine::kCompiledIn ? find_excess(*set, w, error_nm_)
                                             : find_kept_excess(*set, work_, error_nm_);
  // A sum is finite only if all in it is (IEEE 754-2019, 6.1 and 6.2); where fewer axes correct,
  // the rest is 0.
  if (VOLCOMP_UNLIKELY(!possible || !Magnitude::finite(w.excess[0] + w.excess[1] + w.excess[2])))
    return detail::tick_slow_path(*this, in, ramp, out);
  FastPathBits changed = 0;
  for_each_correcting([&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    put_out(c, w.excess[c], ramp, common, changed, out);
  });
  tally_.enter(kAllValid ^ changed);
  put_out_turns(w, ramp, common, out);
}

}  // namespace volcomp
