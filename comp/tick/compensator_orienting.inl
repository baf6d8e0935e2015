// Axes that hold the direction of the tool. None of it is in the compensator of a machine without.

namespace volcomp {

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::check_orienting(const MachineChain& chain) {
  const MachineDescription& d = chain.description();
  if constexpr (!kOrients) return d.orienting_count == 0 ? Status{} : refuse(Reason::cannot_orient);
  Where where;
  std::uint32_t taken = 0;
  for (std::size_t c = 0; c < d.correcting_count; ++c)
    taken |= 1U << d.correcting[c];
  for (std::size_t o = 0; o < d.orienting_count; ++o) {
    const Joint& joint = chain.axis(d.orienting[o]);
    where.axis = joint.letter;
    if (joint.kind != JointKind::rotary || (taken >> d.orienting[o] & 1U) != 0)
      return refuse(Reason::cannot_orient, where);
    taken |= 1U << d.orienting[o];
  }
  return {};
}

// Calls visit(state, orienting) for each orienting axis.
template <class Machine, std::size_t Knots, class Limiter>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::for_each_orienting(const Visit& visit) {
  if constexpr (kOrients) {
    for (std::size_t o = 0; o < machine_.chain.orienting_count; ++o)
      visit(axis_[machine_.chain.orienting[o]], o);
  }
}

// Within the limit, as long as the axis corrects at all: one that is let go turns nothing, one that
// is held turns what it does. The correcting axes reckon with it.
template <class Machine, std::size_t Knots, class Limiter>
VOLCOMP_INLINE void Compensator<Machine, Knots, Limiter>::allow_turns(
    [[maybe_unused]] Work& work) const {
  if constexpr (kOrients) {
    for (std::size_t o = 0; o < machine_.chain.orienting_count; ++o) {
      const AxisState& s = axis_[machine_.chain.orienting[o]];
      const float held = -static_cast<float>(s.out.offset());
      const bool off = (s.exception & (kNotHomed | kDropped)) != 0;
      TurnRange& range = work.turns.range[o];
      range = {-s.limit.value(), s.limit.value()};
      if ((s.exception & kStale) != 0) range = {held, held};
      if (off) range = {};
    }
  }
}

// What the orienting axes turn, and the error that then is left to the others.
template <class Machine, std::size_t Knots, class Limiter>
[[gnu::noinline]] void Compensator<Machine, Knots, Limiter>::take_turns(
    [[maybe_unused]] const Tables& set, [[maybe_unused]] Work& work,
    [[maybe_unused]] Float3& error_nm) const {
  if constexpr (kOrients) {
    const kernel::ToolTurning t = kernel::tool_turning(machine_, set, work.at, work.turns.angle);
    const auto excess = kernel::tilt_excess(machine_.chain, t);
    for (std::size_t o = 0; o < machine_.chain.orienting_count; ++o) {
      const TurnRange& range = work.turns.range[o];
      const float wanted = excess[o] * kTurnsPerRad;
      float taken = wanted > range.high ? range.high : wanted >= range.low ? wanted : range.low;
      if (!Magnitude::finite(wanted)) taken = 0.0F;  // put_out_slow_path() lets the axis go
      work.turns.excess[o] = wanted;
      t.turn_back(o, taken / kTurnsPerRad, error_nm);
    }
  }
}

// The excess of an axis that takes offsets, else nullptr.
template <class Machine, std::size_t Knots, class Limiter>
float* Compensator<Machine, Knots, Limiter>::excess_of(std::size_t axis) {
  const std::size_t c = machine_.chain.correcting_index[axis];
  if (c != kNotCorrecting) return &work_.excess[c];
  if constexpr (kOrients) {
    const std::size_t o = machine_.chain.orienting_index(axis);
    if (o != kNotOrienting) return &work_.turns.excess[o];
  }
  return nullptr;
}

}  // namespace volcomp
