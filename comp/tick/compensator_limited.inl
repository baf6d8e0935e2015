// The end of a tick in ordinary operation in which bounds act on offsets, or did in the last one.

namespace volcomp {

// Clamp, ramp, round, limit of an axis that the bounds act on. Returns whether it is valid.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE bool Compensator<Machine, Knots, Limiter>::put_out_limited(
    std::size_t axis, AxisState& s, float excess, std::int32_t target, float ramp,
    std::uint32_t ramping, Output& out) {
  std::uint32_t status = 0;
  if (exceeds(excess, s.limit)) {
    if (VOLCOMP_UNLIKELY(!Magnitude::finite(excess))) {
      let_go(axis, ramp, ramping, out);
      return false;
    }
    if (ramping == 0) {
      target = Magnitude::negative(excess) ? s.out.limit() : -s.out.limit();
    } else {
      excess = s.limit.signed_like(excess);
      target = round_half_even(s.ramp_from - ramp * (excess + s.ramp_from));
    }
    status = kClamped;
  }
  status |= s.out.approach(target);
  out.offset[axis] = s.out.offset();
  if (VOLCOMP_UNLIKELY((status & kSettling) != 0)) {
    status = (status | kClamped | kRateLimited) & ~kSettling;
    guarded_axes_ |= 1U << axis;
  }
  const bool valid = status == 0;
  if (valid) status = kValid;
  tally_[axis].enter_ordinary(status);
  out.status[axis] = static_cast<std::uint16_t>(status | ramping);
  return valid;
}

// `limited`: axes the bounds act on. `ended`: axes that are valid again. Bit per axis.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::tick_limited(std::uint32_t limited,
                                                                       std::uint32_t ended,
                                                                       float ramp, Output& out) {
  const std::uint32_t ramping = now_.ramp.at_rest() ? 0U : std::uint32_t{kRamping};
  std::uint32_t invalid = 0;
  for_each_offset([&](std::size_t a, AxisState& s, const float& excess, const std::int32_t& target)
                      VOLCOMP_INLINE_LAMBDA {
                        const std::uint32_t bit = 1U << a;
                        if ((limited & bit) == 0) return;
                        if (!put_out_limited(a, s, excess, target, ramp, ramping, out))
                          invalid |= bit;
                      });
  limited_axes_ |= invalid;
  while (ended != 0) {  // at most kAxes times
    tally_[static_cast<std::size_t>(__builtin_ctz(ended))].enter_ordinary(kValid);
    ended &= ended - 1U;
  }
}

// Visits the axes that take offsets.
template <class Machine, std::size_t Knots, class Limiter>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::for_each_offset(const Visit& visit) {
  const auto correcting = [&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    visit(machine_.chain.correcting[c], corrected(c), work_.excess[c], work_.target[c]);
  };
  if constexpr (Machine::kCompiledIn) {
    for_each_correcting(correcting);
  } else {
    VOLCOMP_LOOP
    for (std::size_t c = 0; c < machine_.chain.correcting_count; ++c)
      correcting(c);
  }
  if constexpr (kOrients) {
    for_each_orienting([&](AxisState& s, std::size_t o) VOLCOMP_INLINE_LAMBDA {
      visit(machine_.chain.orienting[o], s, work_.turns.excess[o], work_.turns.target[o]);
    });
  }
}

template <class Unit>
[[gnu::noinline]] static void detail::tick_limited(Unit& unit, std::uint32_t limited,
                                                   std::uint32_t ended, float ramp,
                                                   typename Unit::Output& out) {
  unit.tick_limited(limited, ended, ramp, out);
}

}  // namespace volcomp
