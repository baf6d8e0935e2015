// Interrupt half of Compensator.

namespace volcomp {

// Visits the axes with constant indices, so that what is kept per axis stays in registers.
template <class Machine, std::size_t Knots>
template <class Visit>
VOLCOMP_INLINE void Compensator<Machine, Knots>::for_each_axis(const Visit& visit) const {
  kernel::visit_each(0, machine_.chain.axes, visit, std::make_index_sequence<kAxes>{});
}

// Whatever changes, the output goes from where it is to where it should be along the ramp.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE void Compensator<Machine, Knots>::begin_change() {
  for (AxisState& s : axis_)
    s.ramp_from = s.output;
  ramp_.restart(settings_.ramp_ticks);
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::take_request() {
  const Request request = request_.load(std::memory_order_acquire);
  active_ = request == Request::activate ? next_ : static_cast<std::int8_t>(-1);
  if (request == Request::activate) {
    next_ = static_cast<std::int8_t>(1 - next_);
    diagnostics_.active_crc = buffer_[static_cast<std::size_t>(active_)].image_crc;
    if (diagnostics_.activations < UINT32_MAX) ++diagnostics_.activations;
  }
  begin_change();
  request_.store(Request::none, std::memory_order_release);
}

// Linear positions beyond 10 km are clamped on the slow path; the upper half of the integer tells.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE bool Compensator<Machine, Knots>::in_reach(std::size_t axis,
                                                          std::int64_t position) const {
  constexpr std::uint32_t kBlocks = kMaxPosition >> 32U;
  return rotary(axis) || static_cast<std::uint32_t>(position >> 32) + kBlocks < 2U * kBlocks;
}

// Returns the first bits of the status word of this tick. The usual sample is valid, referenced,
// follows a good one and is no further from it than the axis can have moved.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE std::uint32_t Compensator<Machine, Knots>::take_sample(std::size_t axis,
                                                                      const AxisSample& sample) {
  AxisState& s = axis_[axis];
  const auto most = static_cast<std::uint64_t>(s.most_step);
  const auto moved =
      static_cast<std::uint64_t>(sample.position) - static_cast<std::uint64_t>(s.seen);
  std::uint32_t status = 0;
  if (sample.valid && sample.homed && s.steady && moved + most <= 2U * most &&
      in_reach(axis, sample.position)) {
    s.seen = s.position = sample.position;
  } else {
    status = take_unusual_sample(axis, sample);
    if (!s.steady) return status;
  }
  const std::int64_t low = rotary(axis) ? s.position >> 8 : s.position;
  s.direction.update(static_cast<std::uint32_t>(low), s.hysteresis);
  return status;
}

// A first, lost, implausible, returning, unreferenced or absurdly large sample.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] std::uint32_t Compensator<Machine, Knots>::take_unusual_sample(
    std::size_t axis, const AxisSample& sample) {
  AxisState& s = axis_[axis];
  const std::int64_t position =
      rotary(axis) ? clamp_turning(sample.position) : clamp_position(sample.position);
  std::uint32_t status = sample.homed ? 0U : std::uint32_t{kNotHomed};
  const std::int64_t moved = position - s.seen;
  const bool plausible = !s.known || (moved <= s.most_step && moved >= -s.most_step);
  s.steady = sample.valid && plausible;
  if (sample.valid) s.seen = position;
  if (s.steady) {
    if (!s.known) --unknown_axes_;
    s.known = true;
    s.stale_ticks = 0;
    s.position = position;
    return status;
  }
  status |= kStale;
  if (sample.valid) status |= kImplausible;
  if (s.stale_ticks >= settings_.stale_drop_ticks) status |= kDropped;
  if (s.stale_ticks < UINT16_MAX) ++s.stale_ticks;
  return status;
}

// Where the axis stands in its table: target mode adds the offset the drive will have applied.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE Located Compensator<Machine, Knots>::place(std::size_t axis, const Tables& set,
                                                          bool add_offset, std::uint32_t& status) {
  const AxisState& s = axis_[axis];
  const bool turns = rotary(axis);
  std::int64_t q = s.position;
  if (add_offset) q += turns ? std::int64_t{s.output} * 256 : std::int64_t{s.output};
  const Index at = locate(set.lookup[axis], q, turns);
  if (at.range != RangeState::inside) status |= kOutOfRange;
  if (at.range == RangeState::far_outside) status |= kFarOutOfRange;
  const auto& rows = set.rows[axis];
  const Direction direction = s.direction.direction();
  if (direction == Direction::unknown) {
    status |= kDirectionUnknown;
    return {&rows[0][at.row], &rows[1][at.row], at.t, at.u};
  }
  return {&rows[static_cast<std::size_t>(direction)][at.row], nullptr, at.t, at.u};
}

// Offsets of the correcting axes, nm or 2^-32 turn, before any limit.
template <class Machine, std::size_t Knots>
VOLCOMP_INLINE kernel::Offsets Compensator<Machine, Knots>::wanted_offsets(StatusWords& status) {
  const Tables& set = buffer_[static_cast<std::size_t>(active_)];
  const bool add_offset = settings_.source == PositionSource::target;
  std::array<Located, kAxes> at{};
  for_each_axis([&](std::size_t a)
                    VOLCOMP_INLINE_LAMBDA { at[a] = place(a, set, add_offset, status[a]); });
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
    if (!possible) status[a] |= kNoAuthority;
  }
  return offsets;
}

// What makes an output more than clamp, round and slew.
inline constexpr std::uint32_t kUnusualOutput =
    kNotHomed | kStale | kDropped | kNoAuthority | kNoTables | kRamping;

template <class Machine, std::size_t Knots>
VOLCOMP_INLINE auto Compensator<Machine, Knots>::put_out(AxisState& s, float wanted, float ramp,
                                                         std::uint32_t status) -> PutOut {
  if ((status & kUnusualOutput) != 0 || s.soft) return put_out_unusual(s, wanted, ramp, status);
  bool hit = false;
  const float x = Limiter<float>{s.limit, 0.0F}.clamp(wanted, hit);
  if (hit) status |= kClamped;
  const std::int32_t output =
      Limiter<std::int32_t>{0, s.rate}.slew(round_half_even(x), s.output, hit);
  if (hit) status |= kRateLimited;
  return {output, status};
}

// The same with everything that can be going on: ramp, hold, gating to 0 and the soft way back.
template <class Machine, std::size_t Knots>
[[gnu::noinline]] auto Compensator<Machine, Knots>::put_out_unusual(AxisState& s, float wanted,
                                                                    float ramp,
                                                                    std::uint32_t status)
    -> PutOut {
  const bool off = (status & (kNotHomed | kDropped | kNoTables)) != 0;
  const bool held = !off && (status & (kStale | kNoAuthority)) != 0;
  bool hit = false;
  float x = Limiter<float>{s.limit, 0.0F}.clamp(off ? 0.0F : wanted, hit);
  if (hit) status |= kClamped;
  const auto from = static_cast<float>(s.ramp_from);
  if (ramp < 1.0F) x = from + ramp * (x - from);  // at the end exactly x
  // A drive may have started with more than the limit; what remains of it is beyond the rounding.
  const float representable = Limiter<float>{kMaxRounded, 0.0F}.clamp(x, hit);
  const std::int32_t rounded = held ? s.output : round_half_even(representable);

  s.soft = s.soft || (off && (status & kNoTables) == 0);
  const std::int32_t rate = s.soft ? s.soft_rate : s.rate;
  const std::int32_t output = Limiter<std::int32_t>{0, rate}.slew(rounded, s.output, hit);
  if (hit && !s.soft) status |= kRateLimited;
  if (!hit && !off) s.soft = false;
  return {output, status};
}

template <class Machine, std::size_t Knots>
[[gnu::noinline]] void Compensator<Machine, Knots>::count_changes(std::size_t axis,
                                                                  std::uint32_t status) {
  std::uint32_t began = status & ~std::uint32_t{axis_[axis].status};
  axis_[axis].status = static_cast<std::uint16_t>(status);
  while (began != 0) {  // at most kStatusBits times
    const auto bit = static_cast<std::size_t>(__builtin_ctz(began));
    std::uint16_t& count = diagnostics_.began[axis][bit];
    if (count < UINT16_MAX) ++count;
    began &= began - 1U;
  }
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::tick(const Input& in, Output& out) {
  if (pending()) take_request();
  std::uint32_t common =
      damaged_.load(std::memory_order_relaxed) ? std::uint32_t{kTableDamaged} : 0U;
  float ramp = 1.0F;
  if (ramp_.running()) {
    common |= kRamping;
    ramp = ramp_.advance();
  }
  StatusWords status{};
  for_each_axis([&](std::size_t a)
                    VOLCOMP_INLINE_LAMBDA { status[a] = common | take_sample(a, in.axis[a]); });

  kernel::Offsets wanted{};
  std::uint32_t gate = kNoTables;
  if (active_ >= 0) {
    gate = unknown_axes_ == 0 ? 0U : std::uint32_t{kStale};  // an axis has never reported: hold all
    if (unknown_axes_ == 0) wanted = wanted_offsets(status);
  }
  const auto put = [&](std::size_t c) VOLCOMP_INLINE_LAMBDA {
    const std::size_t a = machine_.chain.correcting[c];
    AxisState& s = axis_[a];
    const PutOut result = put_out(s, wanted[c], ramp, status[a] | gate);
    s.output = result.output;
    status[a] = result.status;
    const std::int32_t size = s.output < 0 ? -s.output : s.output;
    if (size > diagnostics_.largest[a]) diagnostics_.largest[a] = size;
  };
  kernel::visit_each(0, machine_.chain.correcting_count, put,
                     std::make_index_sequence<kMaxCorrecting>{});
  for_each_axis([&](std::size_t a) VOLCOMP_INLINE_LAMBDA {
    constexpr std::uint32_t kNothingToReport = kDirectionUnknown | kRamping;
    std::uint32_t word = status[a];
    if ((word & ~kNothingToReport) == 0) word |= kValid;
    if (word != axis_[a].status) count_changes(a, word);
    out.offset[a] = axis_[a].output;
    out.status[a] = static_cast<std::uint16_t>(word);
  });
  if (diagnostics_.ticks < UINT32_MAX) ++diagnostics_.ticks;
}

}  // namespace volcomp
