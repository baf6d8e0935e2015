// The strokes of a helical grinder: process data in, learned offsets to C, learning on command.

#include <algorithm>

#include "firmware/node/node.hpp"

namespace volcomp::node {

using canopen::AbortCode;

namespace {

constexpr std::uint16_t kMeans = 0x2516;
constexpr std::size_t kC = 2;  // of a StrokeService

constexpr std::uint32_t bit(std::size_t axis) { return 1U << axis; }

std::uint8_t number_of(const Status& status) { return static_cast<std::uint8_t>(status.reason); }

}  // namespace

// --- tick

bool Node::learns_for(std::size_t axis) const { return strokes_.on() && axis == strokes_.axis(kC); }

StrokeAxisReport Node::stroke_report(std::size_t axis) const {
  StrokeAxisReport r;
  r.target = objects_.target[axis];
  r.actual = objects_.actual[axis];
  r.has_target = (arrived_.target & bit(axis)) != 0;
  r.has_actual = (arrived_.actual & bit(axis)) != 0;
  r.homed = input_.axis[axis].homed;
  return r;
}

std::int32_t Node::tick_strokes() {
  if (!strokes_.on()) return 0;
  const std::uint32_t missed = device_.sync().missed();
  StrokeCycle cycle;
  for (std::size_t i = 0; i < kStrokeAxes; ++i)
    cycle.axis[i] = stroke_report(strokes_.axis(i));
  cycle.syncs = static_cast<std::uint16_t>(1U + missed - syncs_missed_);
  cycle.has_state = arrived_.process_state;
  cycle.corrected = running_ && (correcting_axes() & bit(strokes_.axis(kC))) != 0;
  syncs_missed_ = missed;
  return strokes_.tick(cycle);
}

void Node::restart_strokes() {
  if (!strokes_.on()) return;
  std::array<WireScale, kStrokeAxes> scale;
  for (std::size_t i = 0; i < kStrokeAxes; ++i)
    scale[i] = scale_[strokes_.axis(i)];
  syncs_missed_ = device_.sync().missed();
  static_cast<void>(
      report_strokes(strokes_.restart(scale, objects_.communication.cycle_period_us)));
}

void Node::stop_strokes() { strokes_.stop(); }

// --- background

void Node::poll_strokes() {
  if (device_.state() == canopen::NmtState::operational) strokes_.work();
}

// 2500h:0B, :0C; what was refused is off.
bool Node::report_strokes(const Status& status) {
  objects_.stroke.reason = number_of(status);
  const char* name = status.where.field != nullptr ? status.where.field : "";
  for (char& letter : objects_.stroke.field) {
    letter = *name;
    if (*name != '\0') ++name;
  }
  if (!status.ok()) objects_.stroke.command = static_cast<std::uint8_t>(StrokeCommand::off);
  return status.ok();
}

// Stored settings come one after the other: they are taken over when all of them are there.
AbortCode Node::switch_strokes(StrokeCommand command) {
  if (command == StrokeCommand::off || device_.state() == canopen::NmtState::boot_up) {
    strokes_.switch_off();
    return AbortCode::none;
  }
  const bool on = report_strokes(strokes_.switch_on(objects_.communication.cycle_period_us));
  return on ? AbortCode::none : AbortCode::invalid_value;
}

AbortCode Node::learn(LearnCommand command) {
  const Status status = strokes_.learn(command);
  objects_.stroke.learn_reason = number_of(status);
  if (status.ok()) return AbortCode::none;
  return strokes_.on() ? AbortCode::general : AbortCode::device_state;
}

void Node::read_strokes(std::uint16_t index) {
  if (index >= 0x2510 && index <= 0x2524) strokes_.publish();
}

AbortCode Node::read_stroke_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) {
  source = object.index == kMeans ? strokes_.means(object.sub) : learned_image();
  return source.empty() ? AbortCode::no_data : AbortCode::none;
}

// --- tables

AbortCode Node::begin_learned(std::size_t announced, Span<std::uint8_t>& sink) {
  sink = strokes_.buffer();
  return announced <= sink.size() ? AbortCode::none : AbortCode::out_of_memory;
}

Span<const std::uint8_t> Node::learned_image() { return strokes_.image(objects_.machine_id); }

AbortCode Node::finish_learned(std::size_t size) {
  const Status status = strokes_.accept(size, objects_.machine_id);
  objects_.stroke.image_reason = number_of(status);
  return status.ok() ? AbortCode::none : AbortCode::general;
}

// One piece of the stored tables after the other.
void Node::load_learned(Span<const std::uint8_t> piece, std::size_t& size) {
  const Span<std::uint8_t> buffer = strokes_.buffer();
  if (size + piece.size() > buffer.size()) return;
  std::copy(piece.begin(), piece.end(), buffer.begin() + size);
  size += piece.size();
}

// When all settings are there.
void Node::load_strokes(std::size_t learned_size) {
  if (objects_.stroke.command == static_cast<std::uint8_t>(StrokeCommand::off)) return;
  const bool on = report_strokes(strokes_.switch_on(objects_.communication.cycle_period_us));
  if (!on || learned_size == 0) return;
  if (finish_learned(learned_size) == AbortCode::none)
    objects_.stroke.learn_reason = number_of(strokes_.learn(LearnCommand::resume));
}

}  // namespace volcomp::node
