// Background half of Compensator: settings, staging, hand-over.

#include <cstddef>
#include <type_traits>

#include "comp/core/crc32.hpp"

namespace volcomp {

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::configure(const Settings& settings) {
  constexpr std::int32_t kMost = 4'194'303;             // what the rounding can represent
  constexpr std::int32_t kMostRate = 1'000'000'000;     // in effect unlimited
  constexpr std::uint32_t kMostRampTicks = 16'777'216;  // what a float counts exactly
  Where where;
  for (std::size_t a = 0; a < kAxes; ++a) {
    const AxisLimits& l = settings.axis[a];
    where.index = static_cast<int>(a);
    where.axis = machine_.chain.letter[a];
    if (l.limit < 1 || l.limit > kMost) where.field = "limit";
    if (l.rate < 1 || l.rate > kMostRate) where.field = "rate";
    if (l.soft_rate < 1 || l.soft_rate > l.rate) where.field = "soft_rate";
    if (l.hysteresis < 0 || l.hysteresis > kMost) where.field = "hysteresis";
    if (l.max_step < 0) where.field = "max_step";
    if (where.field != nullptr) return refuse(Reason::bad_setting, where);
  }
  if (settings.ramp_ticks < 1 || settings.ramp_ticks > kMostRampTicks) {
    where = {};
    where.field = "ramp_ticks";
    return refuse(Reason::bad_setting, where);
  }
  settings_ = settings;
  next_.ramp.restart(settings.ramp_ticks);
  target_mask_ = settings.source == PositionSource::target ? -1 : 0;
  for (std::size_t a = 0; a < kAxes; ++a)
    apply_limits(a);
  return {};
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::apply_limits(std::size_t axis) {
  const AxisLimits& l = settings_.axis[axis];
  AxisState& s = axis_[axis];
  const std::int64_t any = rotary(axis) ? kAnyTurn : kAnyStep;
  const std::int64_t most = l.max_step == 0 || l.max_step > any ? any : l.max_step;
  s.most_step = static_cast<std::uint64_t>(most);
  s.usual_step = rotary(axis) || s.most_step < kMaxUsualStep ? s.most_step : kMaxUsualStep;
  if (s.reach != 0) s.reach = s.usual_step;
  s.limit = Magnitude(static_cast<float>(l.limit));
  s.rate = l.rate;
  s.soft_rate = l.soft_rate;
  s.hysteresis = l.hysteresis;
}

// What depends on the machine alone. Where fewer than three axes correct, the others stand for the
// first axis.
template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::take_machine() {
  unknown_axes_ = machine_.chain.axes;
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    corrected_[c] = &axis_[machine_.chain.correcting[c]];
  for (std::size_t a = 0; a < kAxes; ++a)
    apply_limits(a);
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::restart(const Machine& machine) {
  if (machine.chain.axes <= kAxes) {
    machine_ = machine;
  } else {
    machine_ = Machine{};
  }
  request_.store(Request::none, std::memory_order_relaxed);
  damaged_.store(false, std::memory_order_relaxed);
  now_ = {};
  staged_ = false;
  diagnostics_ = {};
  report_ = {};
  error_nm_ = {};
  tally_ = {};
  ticks_ = 0;
  ticks_wrapped_ = false;
  ramps_ = 0;
  guarded_axes_ = 0;
  axis_ = {};
  take_machine();
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::start_from(const std::array<std::int32_t, kAxes>& offsets) {
  constexpr std::int32_t kMostStart = 1 << 30;
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (offsets[a] <= kMostStart && offsets[a] >= -kMostStart) continue;
    Where where;
    where.axis = machine_.chain.letter[a];
    where.field = "start offset";
    where.index = static_cast<int>(a);
    return refuse(Reason::bad_setting, where);
  }
  for (std::size_t a = 0; a < kAxes; ++a) {
    const std::int32_t largest = axis_[a].largest;
    axis_[a] = {};
    axis_[a].largest = largest;
    apply_limits(a);
    axis_[a].output = offsets[a];
  }
  unknown_axes_ = machine_.chain.axes;
  if (!now_.ramp.at_rest()) ++ramps_;  // a new beginning
  begin_change();
  now_.ramp = next_.ramp;
  return {};
}

template <class Machine, std::size_t Knots>
std::uint32_t Compensator<Machine, Knots>::checksum(const Tables& set) {
  static_assert(std::is_standard_layout_v<Tables>);
  return crc32({reinterpret_cast<const std::uint8_t*>(&set), offsetof(Tables, checksum)});
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::reject(const Status& status) {
  if (diagnostics_.rejections < UINT32_MAX) ++diagnostics_.rejections;
  diagnostics_.last_rejection = status;
  return status;
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::open_spare(const Provenance& provenance) {
  if (pending()) return refuse(Reason::hand_over_pending);
  staged_ = false;
  if (settings_.machine_id != 0 && provenance.machine_id != settings_.machine_id)
    return refuse(Reason::machine_mismatch);
  return {};
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::fold_into_spare(const RuntimeChain& chain,
                                                    const TablesView& tables,
                                                    const Vec3& tool_point,
                                                    std::uint32_t image_crc) {
  FoldReport report;
  Tables& spare = buffer_[static_cast<std::size_t>(spare_)];
  const Status status = fold_tables(tables, chain, tool_point, TableSetView(spare), report);
  if (!status.ok()) return status;
  spare.image_crc = image_crc;
  spare.checksum = checksum(spare);
  report_ = report;
  staged_ = true;
  return {};
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::stage_for(const RuntimeChain& chain, const TablesView& tables,
                                              const Vec3& tool_point, std::uint32_t image_crc) {
  Status status = open_spare(tables.provenance);
  if (status.ok()) status = check_orienting(tables.chain);
  if (status.ok()) status = fold_into_spare(chain, tables, tool_point, image_crc);
  return status.ok() ? status : reject(status);
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::stage(const TablesView& tables, const Vec3& tool_point,
                                          std::uint32_t image_crc) {
  return stage_for(machine_.chain, tables, tool_point, image_crc);
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::adopt(const Machine& machine) {
  const bool staged = staged_;
  const FoldReport report = report_;
  restart(machine);
  staged_ = staged;
  report_ = report;
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::stage(const MachineTables& tables, const Vec3& tool_point,
                                          std::uint32_t image_crc,
                                          const Temperatures& temperatures) {
  TablesView view;
  Status status = open_spare(tables.provenance);
  if (status.ok()) status = view_tables(tables, view);
  view.strain = strains(view, temperatures);
  if (status.ok()) status = check_orienting(view.chain);
  if (status.ok()) status = fold_into_spare(machine_.chain, view, tool_point, image_crc);
  return status.ok() ? status : reject(status);
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::activate() {
  if (!staged_) return refuse(Reason::not_staged);
  staged_ = false;
  damaged_.store(false, std::memory_order_relaxed);
  request_.exchange(Request::none, std::memory_order_acquire);  // a deactivation is overtaken
  next_.active = next_.latest = &buffer_[static_cast<std::size_t>(spare_)];
  next_.activations = now_.activations + 1U;
  spare_ = static_cast<std::int8_t>(1 - spare_);
  request_.store(Request::activate, std::memory_order_release);
  return {};
}

template <class Machine, std::size_t Knots>
void Compensator<Machine, Knots>::deactivate() {
  const Request before = request_.exchange(Request::none, std::memory_order_acq_rel);
  if (before == Request::activate)
    spare_ = static_cast<std::int8_t>(1 - spare_);  // the tick has not taken them
  next_.active = nullptr;
  next_.latest = now_.latest;
  next_.activations = now_.activations;
  request_.store(Request::deactivate, std::memory_order_release);
}

template <class Machine, std::size_t Knots>
Status Compensator<Machine, Knots>::scrub() {
  const Tables* const set = now_.active;
  if (set == nullptr || pending()) return {};
  if (checksum(*set) == set->checksum) return {};
  damaged_.store(true, std::memory_order_relaxed);
  deactivate();
  return reject(refuse(Reason::crc_mismatch));
}

template <class Machine, std::size_t Knots>
Diagnostics<Compensator<Machine, Knots>::kAxes> Compensator<Machine, Knots>::diagnostics() const {
  const auto saturated = [](std::uint32_t n) {
    return static_cast<std::uint16_t>(n < UINT16_MAX ? n : UINT16_MAX);
  };
  Diagnostics<kAxes> d = diagnostics_;
  d.ticks = ticks_wrapped_ ? UINT32_MAX : ticks_;
  d.activations = now_.activations;
  if (now_.latest != nullptr) d.active_crc = now_.latest->image_crc;
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    d.largest[a] = axis_[a].largest;
    d.began[a][bit_of(kRamping)] = saturated((ramps_ >> 1U) + (ramps_ & 1U));
  }
  for (std::size_t c = 0; c < machine_.chain.correcting_count; ++c) {
    auto& began = d.began[machine_.chain.correcting[c]];
    std::array<std::uint32_t, kEverydayWidth> more{};
    tally_.add_to(more, c);
    began[bit_of(kValid)] = saturated(began[bit_of(kValid)] + more[0]);
    began[bit_of(kClamped)] = saturated(began[bit_of(kClamped)] + more[1]);
    began[bit_of(kRateLimited)] = saturated(began[bit_of(kRateLimited)] + more[2]);
  }
  return d;
}

}  // namespace volcomp
