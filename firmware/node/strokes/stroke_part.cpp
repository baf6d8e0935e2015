#include "firmware/node/strokes/stroke_part.hpp"

#include <algorithm>

#include "firmware/node/object_handles.hpp"

namespace volcomp::node {

using canopen::AbortCode;

namespace {

constexpr canopen::ObjectId kStrokes = object::stroke::command.id();
constexpr canopen::ObjectId kLearn = object::stroke::learn.id();
constexpr std::size_t kC = 2;  // of a StrokeService

std::uint8_t number_of(const Status& status) { return static_cast<std::uint8_t>(status.reason); }

}  // namespace

WatchedStrokes::WatchedStrokes(NodeCore& core)
    : core_(core), service_(core.objects.stroke, core.preemption) {}

void WatchedStrokes::restart(bool operational) {
  if (!operational || !service_.on()) return;
  std::array<WireScale, kStrokeAxes> scale;
  for (std::size_t i = 0; i < kStrokeAxes; ++i)
    scale[i] = core_.gate[service_.axis(i)].scale();
  syncs_missed_ = core_.device.sync().missed();
  static_cast<void>(report(service_.restart(scale, period_us())));
}

// --- tick

bool WatchedStrokes::learns_for(std::size_t axis) const {
  return service_.on() && axis == service_.axis(kC);
}

void WatchedStrokes::start(const PerAxis<std::int32_t>& held) {
  if (!service_.on()) return;
  const std::size_t c = service_.axis(kC);
  limits_ = core_.limits(c);
  sum_.change(OffsetBounds(limits_));
  sum_.start(held[c]);
}

std::int32_t WatchedStrokes::add(std::int32_t offset, std::int32_t learned) {
  const std::int32_t most = limits_.limit;
  const std::int32_t whole = offset + learned;
  const std::int32_t wanted = std::min(std::max(-most, whole), most);
  std::int32_t put_out = wanted;
  if (!limits_.accelerates_freely()) {
    static_cast<void>(sum_.follow(wanted));
    put_out = sum_.offset();
  }
  if (put_out != whole) show_limited(wanted != whole, put_out != wanted);
  return put_out;
}

// 2524h:03. Bit 14, which tells of the acceleration elsewhere, means another feed there.
void WatchedStrokes::show_limited(bool clamped, bool held_back) {
  std::uint32_t status = core_.objects.stroke.offset_status & ~std::uint32_t{kValid};
  if (clamped) status |= kClamped;
  if (held_back) status |= kRateLimited;
  core_.objects.stroke.offset_status = static_cast<std::uint16_t>(status);
}

StrokeAxisReport WatchedStrokes::axis_report(std::size_t axis) const {
  StrokeAxisReport r;
  r.target = core_.objects.target[axis];
  r.actual = core_.objects.actual[axis];
  r.has_target = core_.has(Arrival::kTarget, axis);
  r.has_actual = core_.has(Arrival::kActual, axis);
  r.homed = core_.input.axis[axis].homed;
  return r;
}

std::int32_t WatchedStrokes::tick() {
  if (!service_.on()) return 0;
  const std::uint32_t missed = core_.device.sync().missed();
  StrokeCycle cycle;
  for (std::size_t i = 0; i < kStrokeAxes; ++i)
    cycle.axis[i] = axis_report(service_.axis(i));
  cycle.syncs = static_cast<std::uint16_t>(1U + missed - syncs_missed_);
  cycle.has_state = (core_.arrived & bit(Arrival::kProcessState)) != 0;
  cycle.corrected = core_.running && core_.corrects(service_.axis(kC));
  syncs_missed_ = missed;
  return service_.tick(cycle);
}

// --- background

void WatchedStrokes::background(std::uint64_t /*now_us*/) {
  if (core_.operational()) service_.work();
}

// --- objects

AbortCode WatchedStrokes::before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
  if (object == kStrokes) return switch_to(static_cast<StrokeCommand>(bytes[0]));
  if (object == kLearn) return learn(static_cast<LearnCommand>(bytes[0]));
  return AbortCode::none;
}

// 2500h:0B, :0C; what was refused is off.
bool WatchedStrokes::report(const Status& status) {
  core_.objects.stroke.reason = number_of(status);
  const char* name = status.where.field != nullptr ? status.where.field : "";
  for (char& letter : core_.objects.stroke.field) {
    letter = *name;
    if (*name != '\0') ++name;
  }
  if (!status.ok()) core_.objects.stroke.command = static_cast<std::uint8_t>(StrokeCommand::off);
  return status.ok();
}

// Stored settings come one after the other: they are taken over when all of them are there.
AbortCode WatchedStrokes::switch_to(StrokeCommand command) {
  if (command == StrokeCommand::off || core_.booting()) {
    service_.switch_off();
    return AbortCode::none;
  }
  const bool on = report(service_.switch_on(period_us()));
  return on ? AbortCode::none : AbortCode::invalid_value;
}

AbortCode WatchedStrokes::learn(LearnCommand command) {
  const Status status = service_.learn(command);
  core_.objects.stroke.learn_reason = number_of(status);
  if (status.ok()) return AbortCode::none;
  return service_.on() ? AbortCode::general : AbortCode::device_state;
}

void WatchedStrokes::before_read(canopen::ObjectId object) {
  if (object.index >= object::stroke::frames.index &&
      object.index <= object::stroke::table_state.index)
    service_.publish();
}

AbortCode WatchedStrokes::read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) {
  source =
      object.index == object::stroke::means.index ? service_.means(object.sub) : learned_image();
  return source.empty() ? AbortCode::no_data : AbortCode::none;
}

// --- tables

// 2526h:01 is the only one that can be written.
AbortCode WatchedStrokes::begin_domain(std::size_t announced, Span<std::uint8_t>& sink) {
  sink = service_.buffer();
  return announced <= sink.size() ? AbortCode::none : AbortCode::out_of_memory;
}

Span<const std::uint8_t> WatchedStrokes::learned_image() {
  return service_.image(core_.objects.machine_id);
}

AbortCode WatchedStrokes::finish_domain(std::size_t size) {
  const Status status = service_.accept(size, core_.objects.machine_id);
  core_.objects.stroke.image_reason = number_of(status);
  return status.ok() ? AbortCode::none : AbortCode::general;
}

void WatchedStrokes::load_learned(Span<const std::uint8_t> piece, std::size_t& size) {
  const Span<std::uint8_t> buffer = service_.buffer();
  if (size + piece.size() > buffer.size()) return;
  std::copy(piece.begin(), piece.end(), buffer.begin() + size);
  size += piece.size();
}

void WatchedStrokes::finish_loading(std::size_t learned_size) {
  if (core_.objects.stroke.command == static_cast<std::uint8_t>(StrokeCommand::off)) return;
  const bool on = report(service_.switch_on(period_us()));
  if (!on || learned_size == 0) return;
  if (finish_domain(learned_size) == AbortCode::none)
    core_.objects.stroke.learn_reason = number_of(service_.learn(LearnCommand::resume));
}

}  // namespace volcomp::node
