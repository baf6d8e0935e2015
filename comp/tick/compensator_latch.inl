// The error of the machine where a probe has latched its axes: the tables and the kernel of the
// tick, none of its state.

namespace volcomp {

template <class Machine, std::size_t Knots, class Limiter>
PoseError Compensator<Machine, Knots, Limiter>::error_at(
    const std::array<LatchedAxis, kMaxAxes>& latched) const {
  PoseError error;
  const Tables* const set = now_.active.get();
  if (set == nullptr) return error;
  error.known = true;
  // Filled step by step, and all of it before it is read.
  Work work;                     // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::array<Knot, kAxes> mean;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    const bool turns = rotary(a);
    std::int64_t r = distance(set->lookup[a], latched[a].position, 0, turns);
    if (outside(set->lookup[a], r, turns, set->lookup[a].travel)) {
      hold_inside(set->lookup[a], r);
      error.within = false;
    }
    if (latched[a].direction == Direction::unknown) mean[a].d = {};
    locate_any(set->lookup[a], static_cast<std::uint32_t>(r), turns, set->rows[a].data(),
               latched[a].direction, mean[a], work.at[a]);
  }
  if constexpr (kOrients) work.turns.range = {};
  Float3 e{};
  static_cast<void>(find_kept_excess(*set, work, e));
  error.base = {static_cast<double>(e[0]), static_cast<double>(e[1]), static_cast<double>(e[2])};
  return error;
}

}  // namespace volcomp
