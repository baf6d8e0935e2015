// The usual tick: every sample is good, every axis inside its table. One straight run of
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
template <class Machine, std::size_t Knots>
template <bool Turns>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::within_reach(const AxisState& s,
                                                              std::int64_t position) {
  const auto moved = static_cast<std::uint64_t>(position) - static_cast<std::uint64_t>(s.seen);
  if (Turns) return moved + s.usual_step < s.window;
  return static_cast<std::uint32_t>(moved + s.usual_step) < static_cast<std::uint32_t>(s.window);
}

// The usual sample is valid, referenced, no further from the last one than the axis can have moved,
// and inside the table. Target mode adds the offset the drive will have applied.
template <class Machine, std::size_t Knots>
template <bool Turns>
VOLCOMP_INLINE Located Compensator<Machine, Knots>::follow_as(std::size_t axis,
                                                              const AxisSample& sample,
                                                              const Tables& set) {
  AxisState& s = axis_[axis];
  const AxisLookup& lookup = set.lookup[axis];
  if (VOLCOMP_RARELY(!sample.valid || !sample.homed)) return follow_unusual(axis, sample, set);
  if (VOLCOMP_RARELY(!within_reach<Turns>(s, sample.position)))
    return follow_unusual(axis, sample, set);
  const std::int64_t r = distance(lookup, sample.position, s.output & target_mask_, Turns);
  if (VOLCOMP_RARELY(outside(lookup, r, Turns, lookup.usual_travel)))
    return follow_unusual(axis, sample, set);
  s.seen = sample.position;
  const std::int64_t low = Turns ? sample.position >> 8 : sample.position;
  const Direction d = s.direction.follow(static_cast<std::uint32_t>(low), s.hysteresis);
  return locate(lookup, static_cast<std::uint32_t>(r), Turns, set.rows[axis].data(), d);
}

// The kind of an axis is asked for once.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE Located Compensator<Machine, Knots>::follow(std::size_t axis,
                                                           const AxisSample& sample,
                                                           const Tables& set) {
  return rotary(axis) ? follow_as<true>(axis, sample, set) : follow_as<false>(axis, sample, set);
}

// Where this tick works.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE auto Compensator<Machine, Knots>::work(Work& local) -> Work& {
  if constexpr (Machine::kCompiledIn) {
    return local;
  } else {
    return work_;
  }
}

// What the correcting axes have to take away, nm or 2^-32 turn. False without authority.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::find_excess(const Tables& set, Work& work,
                                                             kernel::Excess& excess) {
  const RuntimeChain& chain = machine_.chain;
  if (chain.folded) {
    error_nm_ = kernel::folded_error(machine_, set, work.at);
    excess = chain.inverse.form == InverseForm::aligned
                 ? kernel::aligned_excess(chain.inverse, error_nm_)
                 : kernel::constant_excess(set, error_nm_);
    return true;
  }
  const Float3 e = kernel::recursive_error(machine_, set, work.at, work.carried);
  error_nm_ = e;
  const bool possible = kernel::varying_excess(machine_, work.carried.column, e, excess);
  constexpr float kTurnsPerRad = 683565275.6F;  // 2^32 / 2π
  for_each_correcting([&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    if (rotary(chain.correcting[c])) excess[c] *= kTurnsPerRad;
  });
  return possible;
}

// Clamp, ramp, round, slew: the offset that takes `excess` away.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::put_out(std::size_t correcting, float excess,
                                                         float ramp, std::uint32_t usual,
                                                         EverydayBits& everyday, Output& out) {
  const std::size_t a = machine_.chain.correcting[correcting];
  AxisState& s = axis_[a];
  out.status[a] = static_cast<std::uint16_t>(usual);
  if (VOLCOMP_RARELY(exceeds(excess, s.limit))) {
    excess = excess < 0.0F ? -s.limit.value() : s.limit.value();
    limited(correcting, kClamped, everyday, out);
  }
  std::int32_t output = round_half_even(s.ramp_from - ramp * (excess + s.ramp_from));
  if (VOLCOMP_RARELY(further(output, s.output, s.rate))) {
    output = output < s.output ? s.output - s.rate : s.output + s.rate;
    limited(correcting, kRateLimited, everyday, out);
  }
  s.output = output;
  if (VOLCOMP_RARELY(further(output, 0, s.largest))) s.largest = output < 0 ? -output : output;
  out.offset[a] = output;
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::limited(std::size_t correcting, StatusBit how,
                                                         EverydayBits& everyday, Output& out) {
  std::uint16_t& status = out.status[machine_.chain.correcting[correcting]];
  status = static_cast<std::uint16_t>((status & ~std::uint32_t{kValid}) | how);
  everyday &= ~everyday_of(correcting, everyday_bits(kValid));
  everyday |= everyday_of(correcting, everyday_bits(how));
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::tick(const Input& in, Output& out) {
  if (VOLCOMP_RARELY(++ticks_ == 0)) ticks_wrapped_ = true;
  if (VOLCOMP_RARELY(request_.load(std::memory_order_relaxed) != Request::none)) take_request();
  std::uint32_t usual = kValid;
  float ramp = 1.0F;
  if (VOLCOMP_RARELY(ramp_.running())) {
    usual |= kRamping;
    ramp = advance_ramp();
  }
  if (VOLCOMP_RARELY(usable_ == nullptr) && !ready(in)) return idle(in, ramp, out);

  const Tables& set = *usable_;
  Work local;
  Work& w = work(local);
  for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA { w.at[a] = follow(a, in.axis[a], set); });
  kernel::Excess excess;
  const bool possible = find_excess(set, w, excess);
  if (VOLCOMP_RARELY(guarded_axes_ != 0 || !possible)) {
    excess_ = excess;
    return finish_unusual(possible ? 0U : std::uint32_t{kNoAuthority}, ramp, out);
  }
  EverydayBits everyday = all_valid(machine_.chain.correcting_count);
  for_each_correcting([&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    put_out(c, excess[c], ramp, usual, everyday, out);
  });
  tally_.enter(everyday);
  for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    if (machine_.chain.correcting_index[a] != kNotCorrecting) return;
    out.offset[a] = axis_[a].output;
    out.status[a] = static_cast<std::uint16_t>(usual);
  });
}

}  // namespace volcomp
