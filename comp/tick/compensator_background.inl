// Background half of Compensator: settings, staging, hand-over.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "comp/core/crc32.hpp"

namespace volcomp {

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::configure(const Settings& settings) {
  constexpr std::uint32_t kMostRampTicks = 16'777'216;  // what a float counts exactly
  Where where;
  for (std::size_t a = 0; a < kAxes; ++a) {
    const AxisLimits& l = settings.axis[a];
    where.index = static_cast<int>(a);
    where.axis = machine_.chain.letter[a];
    where.field = refused_field(l);
    if (!Limiter::kAccelerates && l.acceleration != 0) where.field = "acceleration";
    if (l.hysteresis < 0 || l.hysteresis > kMostOffsetLimit) where.field = "hysteresis";
    if (l.max_step < 0) where.field = "max_step";
    if (where.field != nullptr) return refuse(Reason::bad_setting, where);
  }
  if (settings.ramp_ticks < 1 || settings.ramp_ticks > kMostRampTicks) {
    where = {};
    where.field = "ramp_ticks";
    return refuse(Reason::bad_setting, where);
  }
  settings_ = settings;
  next_ramp_.restart(settings.ramp_ticks);
  for (std::size_t a = 0; a < kAxes; ++a)
    apply_limits(a);
  apply_directions();
  return {};
}

template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::apply_limits(std::size_t axis) {
  const AxisLimits& l = settings_.axis[axis];
  AxisState& s = axis_[axis];
  const std::int64_t any = rotary(axis) ? kAnyTurn : kAnyStep;
  const std::int64_t most = l.max_step == 0 || l.max_step > any ? any : l.max_step;
  s.most_step = static_cast<std::uint64_t>(most);
  s.fast_path_step =
      rotary(axis) || s.most_step < kMaxFastPathStep ? s.most_step : kMaxFastPathStep;
  if (s.reach != 0) s.reach = s.fast_path_step;
  s.limit = Magnitude(static_cast<float>(l.limit));
  s.out.change(OffsetBounds(l));
  guarded_axes_ |= 1U << axis;  // the offset may be beyond the new limit
}

// Which offsets count for positions and directions; last of what is derived from settings and
// machine.
template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::apply_directions() {
  masks_.target = settings_.source == PositionSource::target ? -1 : 0;
  masks_.follow = directions_follow_offsets(machine_.chain) ? masks_.target : 0;
  apply_hysteresis();
  settings_crc_ = settings_checksum();
}

// Also while ticks come: a hysteresis that becomes wider turns no direction, and one that becomes
// narrower fits the tables that are left.
template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::apply_hysteresis() {
  for (std::size_t a = 0; a < kAxes; ++a)
    axis_[a].hysteresis.set(needed_hysteresis(a));
}

template <class Machine, std::size_t Knots, class Limiter>
std::int32_t Compensator<Machine, Knots, Limiter>::needed_hysteresis(std::size_t axis) const {
  std::int32_t needed = settings_.axis[axis].hysteresis;
  for (const auto& reversal_nm : reversal_nm_)
    needed = std::max(needed, reversal_nm[axis] & masks_.follow);
  return needed;
}

// What depends on the machine alone. Where fewer than three axes correct, the others stand for the
// first axis.
template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::take_machine() {
  unknown_axes_ = machine_.chain.axes;
  machine_crc_ = crc32(bytes_of(machine_));
  for (std::size_t c = 0; c < kMaxCorrecting; ++c)
    corrected_[c] = &axis_[machine_.chain.correcting[c]];
  for (std::size_t a = 0; a < kAxes; ++a) {
    apply_limits(a);
    axis_[a].out.start(0);
  }
  apply_directions();
}

template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::restart(const Machine& machine) {
  if (machine.chain.axes <= kAxes) {
    machine_ = machine;
  } else {
    machine_ = Machine{};
  }
  requested_.store(0, std::memory_order_relaxed);
  wanted_.store(nullptr, std::memory_order_relaxed);
  damaged_.store(0, std::memory_order_relaxed);
  now_ = {};
  latest_ = nullptr;
  activations_ = 0;
  staged_ = false;
  rejections_ = 0;
  last_rejection_ = {};
  report_ = {};
  error_nm_ = {};
  tally_ = {};
  ticks_ = 0;
  ticks_wrapped_ = false;
  ramps_ = 0;
  guarded_axes_ = kNoAxes;
  limited_axes_ = 0;
  reversal_nm_[1U - spare_] = {};  // the spare buffer keeps what is staged
  axis_ = {};
  take_machine();
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::start_from(
    const std::array<std::int32_t, kAxes>& offsets) {
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (offsets[a] <= kMostHeldOffset && offsets[a] >= -kMostHeldOffset) continue;
    Where where;
    where.axis = machine_.chain.letter[a];
    where.field = "start offset";
    where.index = static_cast<int>(a);
    return refuse(Reason::bad_setting, where);
  }
  for (std::size_t a = 0; a < kAxes; ++a) {
    const Limiter out = axis_[a].out;
    axis_[a] = {};
    axis_[a].out = out;
    apply_limits(a);
    axis_[a].out.start(offsets[a]);
    tally_[a].forget();
  }
  apply_directions();
  unknown_axes_ = machine_.chain.axes;
  if (!now_.ramp.at_rest()) ramps_.set(ramps_.own() + 1U);  // a new beginning
  begin_change<false>();
  now_.ramp = next_ramp_;
  return {};
}

template <class Machine, std::size_t Knots, class Limiter>
std::uint32_t Compensator<Machine, Knots, Limiter>::checksum(const Tables& set) {
  static_assert(std::is_standard_layout_v<Tables>);
  return crc32({reinterpret_cast<const std::uint8_t*>(&set), offsetof(Tables, checksum)});
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::reject(const Status& status) {
  if (rejections_ < UINT32_MAX) ++rejections_;
  last_rejection_ = status;
  return status;
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::open_spare(const Provenance& provenance) {
  if (pending()) return refuse(Reason::hand_over_pending);
  staged_ = false;
  if (settings_.machine_id != 0 && provenance.machine_id != settings_.machine_id)
    return refuse(Reason::machine_mismatch);
  return {};
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::fold_into_spare(const RuntimeChain& chain,
                                                             const TablesView& tables,
                                                             const Vec3& tool_point,
                                                             std::uint32_t image_crc) {
  FoldReport report;
  Tables& spare = buffer_[spare_];
  const Status status = fold_tables(tables, chain, tool_point, TableSetView(spare), report);
  if (!status.ok()) return status;
  spare.image_crc = image_crc;
  spare.checksum = checksum(spare);
  report_ = report;
  reversal_nm_[spare_] = report.reversal_nm;
  apply_hysteresis();
  staged_ = true;
  return {};
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::stage_for(const RuntimeChain& chain,
                                                       const TablesView& tables,
                                                       const Vec3& tool_point,
                                                       std::uint32_t image_crc) {
  Status status = open_spare(tables.provenance);
  if (status.ok()) status = check_orienting(tables.chain);
  if (status.ok()) status = fold_into_spare(chain, tables, tool_point, image_crc);
  return status.ok() ? status : reject(status);
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::stage(const TablesView& tables, const Vec3& tool_point,
                                                   std::uint32_t image_crc) {
  return stage_for(machine_.chain, tables, tool_point, image_crc);
}

template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::adopt(const Machine& machine) {
  const bool staged = staged_;
  const FoldReport report = report_;
  restart(machine);
  staged_ = staged;
  report_ = report;
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::stage(const MachineTables& tables,
                                                   const Vec3& tool_point, std::uint32_t image_crc,
                                                   const Temperatures& temperatures) {
  TablesView view;
  Status status = open_spare(tables.provenance);
  if (status.ok()) status = view_tables(tables, view);
  view.strain = strains(view, temperatures);
  if (status.ok()) status = check_orienting(view.chain);
  if (status.ok()) status = fold_into_spare(machine_.chain, view, tool_point, image_crc);
  return status.ok() ? status : reject(status);
}

// Overtakes one that no tick has taken yet. What is then the spare buffer is not read by any tick
// after the one that takes this request: after an activation the other one is in force, after a
// deactivation none.
template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::request(const Tables* tables) {
  wanted_.store(tables, std::memory_order_release);
  std::atomic_thread_fence(std::memory_order_seq_cst);
  requested_.store(1, std::memory_order_release);
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::activate() {
  if (!staged_) return refuse(Reason::not_staged);
  staged_ = false;
  damaged_.store(0, std::memory_order_relaxed);
  latest_ = &buffer_[spare_];
  activation_of_[spare_] = ++activations_;
  spare_ = 1U - spare_;
  request(latest_);
  return {};
}

template <class Machine, std::size_t Knots, class Limiter>
void Compensator<Machine, Knots, Limiter>::deactivate() {
  if (activation_waits()) --activations_;
  request(nullptr);
}

// Settings and what the tick takes from them alone.
template <class Machine, std::size_t Knots, class Limiter>
std::uint32_t Compensator<Machine, Knots, Limiter>::settings_checksum() const {
  std::uint32_t crc = crc32(bytes_of(masks_), crc32(bytes_of(settings_)));
  for (const AxisState& s : axis_) {
    const struct {
      std::uint64_t plausible;
      Magnitude limit;
      typename Limiter::Settings out;  // no padding, whose bytes are anything
    } derived{s.fast_path_step ^ ~s.most_step, s.limit, s.out.settings()};
    crc = crc32(bytes_of(derived), crc);
  }
  return crc;
}

// The hysteresis changes with the tables: it is computed anew, so that staging hides no damage.
template <class Machine, std::size_t Knots, class Limiter>
bool Compensator<Machine, Knots, Limiter>::settings_intact() const {
  for (std::size_t a = 0; a < kAxes; ++a)
    if (axis_[a].hysteresis.own() != needed_hysteresis(a) || !axis_[a].out.intact()) return false;
  return settings_checksum() == settings_crc_;
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::scrub(std::size_t bytes) {
  const Tables* const set = now_.active.get();
  if (pending()) return {};
  if (scrub_.set != set || scrub_.activations != activations_)
    scrub_ = {set, activations_, {}, false};
  Where where;
  where.field = "machine";
  Span<const std::uint8_t> part = bytes_of(machine_);
  std::uint32_t wanted = machine_crc_;
  if (scrub_.tables) {
    where.field = nullptr;
    part = {bytes_of(*set).data(), offsetof(Tables, checksum)};
    wanted = set->checksum;
  }
  if (!scrub_.read.read_on(part, bytes)) return {};
  bool whole = scrub_.read.crc == wanted;
  scrub_.tables = !scrub_.tables && set != nullptr;
  if (whole && !settings_intact()) {
    where.field = "settings";
    whole = false;
  }
  if (whole) return {};
  const Status status = refuse(Reason::crc_mismatch, where);
  if (set == nullptr) return status;
  damaged_.store(1, std::memory_order_relaxed);
  deactivate();
  return reject(status);
}

template <class Machine, std::size_t Knots, class Limiter>
Status Compensator<Machine, Knots, Limiter>::scrub() {
  scrub_ = {};
  const Status status = scrub(sizeof(Machine));
  return status.ok() && scrub_.tables ? scrub(sizeof(Tables)) : status;
}

template <class Machine, std::size_t Knots, class Limiter>
Diagnostics<Compensator<Machine, Knots, Limiter>::kAxes>
Compensator<Machine, Knots, Limiter>::diagnostics() const {
  const auto saturated = [](std::uint32_t n) {
    return static_cast<std::uint16_t>(n < UINT16_MAX ? n : UINT16_MAX);
  };
  Diagnostics<kAxes> d;
  d.rejections = rejections_;
  d.last_rejection = last_rejection_;
  d.ticks = ticks_wrapped_.get() ? UINT32_MAX : ticks_.get();
  const Tables* const active = now_.active.get();
  d.activations = active != nullptr ? activation_of_[active == buffer_.data() ? 0 : 1]
                                    : activations_ - (activation_waits() ? 1U : 0U);
  const std::uint32_t ramps = ramps_.get();
  if (const Tables* const latest = active != nullptr ? active : latest_; latest != nullptr)
    d.active_crc = latest->image_crc;
  for (std::size_t a = 0; a < machine_.chain.axes; ++a) {
    d.largest[a] = axis_[a].out.largest();
    d.largest_lag[a] = axis_[a].out.largest_lag();
    for (std::size_t bit = 0; bit < kStatusBits; ++bit)
      d.began[a][bit] = tally_[a].began(bit);
    d.began[a][bit_of(kRamping)] = saturated((ramps >> 1U) + (ramps & 1U));
  }
  return d;
}

}  // namespace volcomp
