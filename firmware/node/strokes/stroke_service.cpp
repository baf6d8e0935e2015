// Strokes on the bus: settings, and the tick.

#include "firmware/node/strokes/stroke_service.hpp"

namespace volcomp::node {

namespace {

constexpr std::uint32_t kDefaultPeriod_us = 1000;  // while 1006h is 0
constexpr std::uint32_t kLongestPeriod_us = 1'000'000;
constexpr std::int32_t kNsPerUs = 1000;

// Places in 2504h.
enum Rule : std::size_t { kWeight, kDeadBand, kMostStep, kMostOffset, kMostSlope, kMostSlotStep };

constexpr bool has(std::uint16_t flags, std::uint16_t flag) { return (flags & flag) != 0; }

Direction direction(std::uint16_t flags) {
  if (has(flags, kStrokeForward) == has(flags, kStrokeBackward)) return Direction::unknown;
  return has(flags, kStrokeForward) ? Direction::forward : Direction::backward;
}

std::int64_t difference(std::int32_t a, std::int32_t b) {
  // Wraps by design: the positions of a rotary drive do.
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

}  // namespace

// --- settings

Status StrokeService::bad(const char* field) {
  Where where;
  where.field = field;
  return refuse(Reason::bad_setting, where);
}

// 0, which the monitor refuses, for a period that no stroke is watched with.
std::int32_t StrokeService::tick_ns(std::uint32_t period_us) {
  if (period_us > kLongestPeriod_us) return 0;
  return static_cast<std::int32_t>(period_us == 0 ? kDefaultPeriod_us : period_us) * kNsPerUs;
}

HelixMonitorSettings StrokeService::monitor_settings(std::uint32_t period_us) const {
  HelixMonitorSettings s;
  s.turn_per_mm = objects_.gear[0];
  s.flank_per_rad = objects_.gear[1];
  s.flank_per_x = objects_.gear[2];
  s.tick_ns = tick_ns(period_us);
  s.z0_nm = objects_.first_node_nm;
  s.node_pitch_nm = objects_.pitch_nm;
  s.nodes = objects_.nodes;
  s.time_line_hz = objects_.frequency_hz;
  s.order_wavelength_mm = objects_.wavelength_mm;
  return s;
}

LearningRules StrokeService::stroke_rules() const {
  LearningRules rules;
  rules.weight = objects_.rules[kWeight];
  rules.dead_sigma = objects_.rules[kDeadBand];
  rules.most_step = objects_.rules[kMostStep];
  rules.most_offset = objects_.rules[kMostOffset];
  rules.most_slope = objects_.rules[kMostSlope];
  rules.least_samples = objects_.least_samples[0];
  rules.spacing = objects_.pitch_nm / kNmPerMm;
  return rules;
}

// Slots are not smoothed: their errors are independent, and C has come to rest before the face, so
// there is no lag to keep out of the loop.
LearningRules StrokeService::slot_rules() const {
  LearningRules rules = stroke_rules();
  rules.periodic = true;
  rules.most_slope = objects_.rules[kMostSlotStep];
  rules.least_samples = objects_.least_samples[1];
  rules.spacing = 1.0;
  rules.taps = {1.0};
  rules.tap_count = 1;
  return rules;
}

Status StrokeService::start_learners() {
  for (auto& learner : stroke_) {
    if (const Status s = learner.start(along_, settings_.nodes); !s.ok()) return s;
  }
  return slot_.start(around_, slots_);
}

Status StrokeService::switch_on(std::uint32_t period_us) {
  on_ = false;
  const Status status = take_settings(period_us);
  on_ = status.ok();
  return status;
}

Status StrokeService::take_settings(std::uint32_t period_us) {
  std::array<std::size_t, kStrokeAxes> axis{};
  for (std::size_t i = 0; i < kStrokeAxes; ++i) {
    if (objects_.axis[i] == 0) return bad("axis");
    axis[i] = objects_.axis[i] - 1U;
  }
  if (axis[kX] == axis[kZ] || axis[kX] == axis[kC] || axis[kZ] == axis[kC]) return bad("axis");
  if (objects_.slots > kGearSlots) return bad("slots");
  // StrokeOffsets holds no more.
  if (!(objects_.rules[kMostOffset] <= 6e-3)) return bad("largest offset");
  const HelixMonitorSettings settings = monitor_settings(period_us);
  if (const Status s = monitor_.configure(settings); !s.ok()) return s;
  if (const Status s = offsets_.configure({objects_.rate, objects_.stale_cycles}); !s.ok())
    return s;
  settings_ = settings;
  along_ = stroke_rules();
  around_ = slot_rules();
  slots_ = objects_.slots;
  if (const Status s = start_learners(); !s.ok()) return s;
  objects_.table_feed = 0;
  axis_ = axis;
  forget();
  return {};
}

Status StrokeService::restart(const std::array<WireScale, kStrokeAxes>& scale,
                              std::uint32_t period_us) {
  for (std::size_t i = 0; i < kStrokeAxes; ++i)
    commanded_[i] = {scale[i], {}, 0, 0, false};
  state_known_ = false;
  flags_ = 0;
  offsets_.restart();
  if (tick_ns(period_us) == settings_.tick_ns) return {};
  settings_.tick_ns = tick_ns(period_us);
  const Status status = monitor_.configure(settings_);
  on_ = status.ok();
  forget();
  return status;
}

// --- tick

TrackedAxis StrokeService::tracked(const StrokeAxisReport& report, const Commanded& axis) const {
  const WireScale linear{axis.scale.numerator, axis.scale.denominator, false};
  const auto lag = static_cast<std::int32_t>(difference(report.actual, axis.wire));
  TrackedAxis t;
  t.command = axis.position;
  t.actual =
      axis.position + WirePosition{}.update(lag, axis.scale.per_turn != 0 ? axis.scale : linear);
  t.valid = axis.known && report.has_actual && state_known_;
  return t;
}

HelixFrame StrokeService::frame(const StrokeCycle& cycle) const {
  HelixFrame f;
  f.x = tracked(cycle.axis[kX], commanded_[kX]);
  f.z = tracked(cycle.axis[kZ], commanded_[kZ]);
  f.c = tracked(cycle.axis[kC], commanded_[kC]);
  const bool c_alone = objects_.target == static_cast<std::uint8_t>(LearningTarget::c_alone);
  if (c_alone && objects_.force != 0) f.z.actual = f.z.command;
  f.sequence = sequence_;
  f.slot = slot_ground_;
  f.stroke = direction(flags_);
  f.in_face = has(flags_, kInFace);
  return f;
}

void StrokeService::take_commands(const StrokeCycle& cycle) {
  for (std::size_t i = 0; i < kStrokeAxes; ++i) {
    const StrokeAxisReport& report = cycle.axis[i];
    Commanded& axis = commanded_[i];
    axis.known = report.has_target;
    if (!report.has_target) continue;
    axis.wire = report.target;
    axis.position = axis.counted.update(report.target, axis.scale);
  }
  state_known_ = cycle.has_state;
  if (!cycle.has_state) return;
  slot_ground_ = objects_.slot;
  flags_ = objects_.flags;
  if (!has(flags_, kInFace)) return;
  if (objects_.feed_nm_per_s < slowest_) slowest_ = objects_.feed_nm_per_s;
  if (objects_.feed_nm_per_s > fastest_) fastest_ = objects_.feed_nm_per_s;
}

StrokeState StrokeService::state(const StrokeCycle& cycle) const {
  const StrokeAxisReport& z = cycle.axis[kZ];
  const StrokeAxisReport& c = cycle.axis[kC];
  StrokeState s;
  s.z_command = commanded_[kZ].position;
  s.feed_nm_per_s = objects_.feed_nm_per_s;
  s.slot = slot_ground_;
  s.stroke = direction(flags_);
  s.in_face = has(flags_, kInFace);
  s.stroke_end = has(flags_, kStrokeEnd);
  s.fresh = cycle.has_state && z.has_target && c.has_target && c.has_actual;
  s.homed = z.homed && c.homed && cycle.corrected;
  return s;
}

void StrokeService::show(std::int32_t offset) {
  const HelixSignals& signals = monitor_.signals();
  objects_.signal_um = {signals.sync_um, signals.lag_c_um, signals.x_um};
  objects_.offset = offset;
  objects_.offset_status = offsets_.status();
  StrokeTableState tables = StrokeTableState::none;
  if (offsets_.active()) tables = StrokeTableState::in_force;
  if (offsets_.pending()) tables = StrokeTableState::waiting;
  objects_.table_state = static_cast<std::uint8_t>(tables);
}

std::int32_t StrokeService::tick(const StrokeCycle& cycle) {
  sequence_ = static_cast<std::uint16_t>(sequence_ + cycle.syncs);
  static_cast<void>(monitor_.tick(frame(cycle)));
  take_commands(cycle);
  const std::int32_t offset = offsets_.tick(state(cycle));
  show(offset);
  if (!cycle.corrected) objects_.offset_status = kNoAuthority;
  return offset;
}

}  // namespace volcomp::node
