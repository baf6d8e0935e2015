// Interrupt half of Compensator.

namespace volcomp {

// Whatever changes, the output goes from where it is to where it should be along the ramp.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::begin_change() {
  for (AxisState& s : axis_)
    s.ramp_from = s.output;
  ramp_.restart(settings_.ramp_ticks);
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::take_request() {
  const Request request = request_.load(std::memory_order_acquire);
  if (request == Request::none) return;
  active_ = request == Request::activate ? next_ : static_cast<std::int8_t>(-1);
  if (request == Request::activate) {
    next_ = static_cast<std::int8_t>(1 - next_);
    diagnostics_.active_crc = buffer_[static_cast<std::size_t>(active_)].image_crc;
    if (diagnostics_.activations < UINT32_MAX) ++diagnostics_.activations;
  }
  begin_change();
  request_.store(Request::none, std::memory_order_release);
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::take_sample(std::size_t axis,
                                                             const AxisSample& sample) {
  AxisState& s = axis_[axis];
  s.status = sample.homed ? 0U : static_cast<std::uint16_t>(kNotHomed);
  if (damaged_.load(std::memory_order_relaxed)) s.status |= kTableDamaged;
  bool good = sample.valid;
  if (good) {
    const std::int64_t position =
        rotary(axis) ? clamp_turning(sample.position) : clamp_position(sample.position);
    const std::int64_t moved = position - s.seen;
    const std::int64_t most = settings_.axis[axis].max_step;
    if (most != 0 && s.known && (moved > most || moved < -most)) {
      good = false;
      s.status |= kImplausible;
    }
    s.seen = position;
    if (good) s.position = position;
  }
  s.known = s.known || good;
  if (good) {
    const auto low = static_cast<std::uint32_t>(rotary(axis) ? s.position >> 8 : s.position);
    s.direction.update(low, settings_.axis[axis].hysteresis);
    s.stale_ticks = 0;
    return;
  }
  s.status |= kStale;
  if (s.stale_ticks >= settings_.stale_drop_ticks) s.status |= kDropped;
  if (s.stale_ticks < UINT16_MAX) ++s.stale_ticks;
}

// Where the axis stands in its table: target mode adds the offset the drive will have applied.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE Located Compensator<Machine, Knots>::place(std::size_t axis, const Tables& set) {
  AxisState& s = axis_[axis];
  const AxisLookup& lookup = set.lookup[axis];
  const bool turns = rotary(axis);
  const Direction direction = s.direction.direction();
  std::int64_t q = s.position;
  if (settings_.source == PositionSource::target)
    q += turns ? std::int64_t{s.output} * 256 : std::int64_t{s.output};
  const Index at = locate(lookup, q, turns);
  if (at.range != RangeState::inside) s.status |= kOutOfRange;
  if (at.range == RangeState::far_outside) s.status |= kFarOutOfRange;
  const auto& rows = set.rows[axis];
  if (direction == Direction::unknown) {
    s.status |= kDirectionUnknown;
    return {&rows[0][at.row], &rows[1][at.row], at.t, at.u};
  }
  return {&rows[static_cast<std::size_t>(direction)][at.row], nullptr, at.t, at.u};
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::all_known() const {
  bool known = true;
  VOLCOMP_UNROLL
  for (std::size_t a = 0; a < kAxes; ++a)
    known = known && (a >= machine_.chain.axes || axis_[a].known);
  return known;
}

// Offsets of the correcting axes, nm or 2^-32 turn, before any limit.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE kernel::Offsets Compensator<Machine, Knots>::wanted_offsets() {
  const Tables& set = buffer_[static_cast<std::size_t>(active_)];
  std::array<Located, kAxes> at{};
  VOLCOMP_UNROLL
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (a < machine_.chain.axes) at[a] = place(a, set);
  }
  if (machine_.chain.folded) {
    error_nm_ = kernel::folded_error(machine_, set, at);
    return kernel::constant_offsets(machine_, set, error_nm_);
  }
  const kernel::Deviation d = kernel::recursive_error(machine_, set, at);
  error_nm_ = d.error;
  kernel::Offsets offsets;
  const bool possible = kernel::varying_offsets(machine_.chain.correcting_count, d, offsets);
  constexpr float kTurnsPerRad = 683565275.6F;  // 2^32 / 2π
  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
    if (c >= machine_.chain.correcting_count) continue;
    const std::size_t a = machine_.chain.correcting[c];
    if (rotary(a)) offsets[c] *= kTurnsPerRad;
    if (!possible) {
      axis_[a].status |= kNoAuthority;
      offsets[c] = static_cast<float>(axis_[a].output);
    }
  }
  return offsets;
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::put_out(std::size_t axis, float wanted,
                                                         float ramp) {
  AxisState& s = axis_[axis];
  const AxisLimits& l = settings_.axis[axis];
  const bool off = (s.status & (kNotHomed | kDropped | kNoTables)) != 0;
  const bool held = !off && (s.status & (kStale | kNoAuthority)) != 0;
  bool hit = false;

  float x = Limiter<float>{static_cast<float>(l.limit), 0.0F}.clamp(off ? 0.0F : wanted, hit);
  if (hit) s.status |= kClamped;
  const auto from = static_cast<float>(s.ramp_from);
  if (ramp < 1.0F) x = from + ramp * (x - from);  // at the end exactly x
  // A drive may have started with more than the limit; what remains of it is beyond the rounding.
  const float representable = Limiter<float>{kMaxRounded, 0.0F}.clamp(x, hit);
  const std::int32_t rounded = held ? s.output : round_half_even(representable);

  s.soft = s.soft || (off && (s.status & kNoTables) == 0);
  const std::int32_t rate = s.soft ? l.soft_rate : l.rate;
  s.output = Limiter<std::int32_t>{0, rate}.slew(rounded, s.output, hit);
  if (hit && !s.soft) s.status |= kRateLimited;
  if (!hit && !off) s.soft = false;
  const std::int32_t size = s.output < 0 ? -s.output : s.output;
  if (size > diagnostics_.largest[axis]) diagnostics_.largest[axis] = size;
}

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::count_changes(std::size_t axis,
                                                               std::uint16_t before) {
  auto began = static_cast<std::uint32_t>(axis_[axis].status & ~before);
  while (began != 0) {  // at most kStatusBits times
    const auto bit = static_cast<std::size_t>(__builtin_ctz(began));
    std::uint16_t& count = diagnostics_.began[axis][bit];
    if (count < UINT16_MAX) ++count;
    began &= began - 1U;
  }
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::tick(const Input& in, Output& out) {
  take_request();
  const std::size_t axes = machine_.chain.axes;
  std::array<std::uint16_t, kAxes> before{};
  VOLCOMP_UNROLL
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (a >= axes) continue;
    before[a] = axis_[a].status;
    take_sample(a, in.axis[a]);
  }

  kernel::Offsets wanted{};
  const bool computable = active_ >= 0 && all_known();
  if (computable) wanted = wanted_offsets();
  const bool ramping = ramp_.running();
  const float ramp = ramp_.advance();

  VOLCOMP_UNROLL
  for (std::size_t c = 0; c < kMaxCorrecting; ++c) {
    if (c >= machine_.chain.correcting_count) continue;
    const std::size_t a = machine_.chain.correcting[c];
    if (active_ < 0) axis_[a].status |= kNoTables;
    if (active_ >= 0 && !computable)
      axis_[a].status |= kStale;  // another axis has never reported: hold
    put_out(a, wanted[c], ramp);
  }
  VOLCOMP_UNROLL
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (a >= axes) continue;
    AxisState& s = axis_[a];
    constexpr std::uint16_t kNotAlarming = kDirectionUnknown;
    if ((s.status & ~kNotAlarming) == 0) s.status |= kValid;
    if (ramping) s.status |= kRamping;
    if (s.status != before[a]) count_changes(a, before[a]);
    out.offset[a] = s.output;
    out.status[a] = s.status;
  }
  if (diagnostics_.ticks < UINT32_MAX) ++diagnostics_.ticks;
}

}  // namespace volcomp
