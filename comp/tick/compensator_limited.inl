// The end of a tick in ordinary operation in which bounds act on offsets, or did in the last one.

namespace volcomp {

// Clamp, ramp, round, limit of an axis that the bounds act on.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::put_out_limited(
    std::size_t axis, AxisState& s, float excess, float ramp, std::uint32_t ramping, Output& out) {
  const std::uint32_t bit = 1U << axis;
  std::uint32_t status = 0;
  if (exceeds(excess, s.limit)) {
    if (VOLCOMP_UNLIKELY(!Magnitude::finite(excess))) return let_go(axis, ramp, ramping, out);
    excess = s.limit.signed_like(excess);
    status = kClamped;
  }
  status |= s.out.approach(round_half_even(s.ramp_from - ramp * (excess + s.ramp_from)));
  out.offset[axis] = s.out.offset();
  if (VOLCOMP_UNLIKELY((status & kSettling) != 0)) {
    status = (status | kClamped | kRateLimited) & ~kSettling;
    guarded_axes_ |= bit;
  }
  if (status == 0) status = kValid;
  if (status != kValid) limited_axes_ |= bit;
  tally_[axis].enter_ordinary(status);
  out.status[axis] = static_cast<std::uint16_t>(status | ramping);
}

// `limited`: axes the bounds act on. `ended`: axes that are valid again. Bit per axis.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::tick_limited(std::uint32_t limited,
                                                                       std::uint32_t ended,
                                                                       float ramp, Output& out) {
  const std::uint32_t ramping = now_.ramp.at_rest() ? 0U : std::uint32_t{kRamping};
  while (limited != 0) {  // at most kAxes times
    const auto a = static_cast<std::size_t>(__builtin_ctz(limited));
    limited &= limited - 1U;
    if (const float* const excess = excess_of(a); excess != nullptr)
      put_out_limited(a, axis_[a], *excess, ramp, ramping, out);
  }
  while (ended != 0) {  // at most kAxes times
    tally_[static_cast<std::size_t>(__builtin_ctz(ended))].enter_ordinary(kValid);
    ended &= ended - 1U;
  }
}

template <class Unit>
[[gnu::noinline]] static void detail::tick_limited(Unit& unit, std::uint32_t limited,
                                                   std::uint32_t ended, float ramp,
                                                   typename Unit::Output& out) {
  unit.tick_limited(limited, ended, ramp, out);
}

}  // namespace volcomp
