#include "comp/probe/touch_collector.hpp"

namespace volcomp {
namespace {

constexpr std::uint8_t kPatience_cycles = 3;

constexpr std::uint32_t bit(std::size_t axis) { return 1U << axis; }

}  // namespace

void TouchCollector::configure(const TouchRules& rules) {
  rules_ = rules;
  touch_.latched.fill({});
  restart();
}

void TouchCollector::restart() {
  for (AxisEdges& axis : axis_)
    axis = {};
  started_ = doubtful_ = counted_ = latched_ = 0;
  any_yet_ = false;
  cycles_open_ = 0;
}

void TouchCollector::report(std::size_t axis, const LatchReport& report) {
  if ((rules_.axes & bit(axis)) == 0) return;
  AxisEdges& a = axis_[axis];
  a.homed = report.homed;
  if (report.latched) {
    latched_ |= bit(axis);
    a.latched = report.axis;
    const std::int64_t half_ns = half_unknown_ns(axis);
    a.time_ns = half_ns != 0 ? static_cast<std::uint32_t>(half_ns) : report.time_ns;
    a.moving = report.moving;
    a.edge_ns = sync_ns_ + a.time_ns - rules_.delay_ns[axis];
  }
  if (report.counted) count(a, bit(axis), report.edge_count);
}

void TouchCollector::count(AxisEdges& a, std::uint32_t bit, std::uint16_t edge_count) {
  const auto more = static_cast<std::uint16_t>(edge_count - a.edge_count);
  a.edge_count = edge_count;
  if ((started_ & bit) == 0) {
    started_ |= bit;
    if (edge_count == 0) return;
    doubtful_ |= bit;
    a.doubtful = kPatience_cycles;
  } else if (more != 0) {
    counted_ |= bit;
    a.edges = static_cast<std::uint16_t>(a.edges + more);
  }
}

void TouchCollector::settle_doubts() {
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    if ((doubtful_ & bit(i)) == 0) continue;
    AxisEdges& a = axis_[i];
    const bool latched = (latched_ & bit(i)) != 0;
    if (latched) {
      ++a.edges;
      counted_ |= bit(i);
    }
    if (latched || --a.doubtful == 0) doubtful_ &= ~bit(i);
  }
}

const Touch* TouchCollector::finish_cycle() {
  sync_ns_ += rules_.period_ns;
  if (doubtful_ != 0) settle_doubts();
  if ((counted_ | latched_) == 0) return nullptr;
  const bool complete = (counted_ & latched_) == rules_.axes;
  if (!complete && ++cycles_open_ < kPatience_cycles) return nullptr;
  close();
  return &touch_;
}

TouchVerdict TouchCollector::judge_axis(std::size_t axis) const {
  const AxisEdges& a = axis_[axis];
  const bool latched = (latched_ & bit(axis)) != 0;
  if (a.edges > 1) return TouchVerdict::double_edge;
  if (a.edges == 0) return latched ? TouchVerdict::stale_latch : TouchVerdict::axis_missing;
  if (!latched) return TouchVerdict::no_position;
  if (a.time_ns > rules_.period_ns) return TouchVerdict::late_latch;
  if (!a.moving) return TouchVerdict::no_velocity;
  return a.homed ? TouchVerdict::point : TouchVerdict::not_homed;
}

// Judges each axis first and returns the first fault; then checks what takes two edges.
TouchVerdict TouchCollector::judge(std::uint8_t& axis) const {
  std::int64_t first_ns = INT64_MAX;
  // Between these two all edges can have been.
  std::int64_t earliest_ns = INT64_MAX;
  std::int64_t latest_ns = INT64_MIN;
  for (std::size_t a = 0; a < kMaxAxes; ++a) {
    if ((rules_.axes & bit(a)) == 0) continue;
    axis = static_cast<std::uint8_t>(a);
    const TouchVerdict verdict = judge_axis(a);
    if (verdict != TouchVerdict::point) return verdict;
    if (axis_[a].edge_ns < first_ns) first_ns = axis_[a].edge_ns;
    const std::int64_t half_ns = half_unknown_ns(a);
    if (axis_[a].edge_ns + half_ns < earliest_ns) earliest_ns = axis_[a].edge_ns + half_ns;
    if (axis_[a].edge_ns - half_ns > latest_ns) latest_ns = axis_[a].edge_ns - half_ns;
    if (latest_ns - earliest_ns > rules_.skew_ns) return TouchVerdict::skew;
  }
  axis = 0;
  if (any_yet_ && first_ns - last_edge_ns_ < rules_.bounce_ns) return TouchVerdict::bounce;
  return TouchVerdict::point;
}

void TouchCollector::close() {
  ++touch_.sequence;
  touch_.verdict = judge(touch_.axis);
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    if ((rules_.axes & bit(i)) == 0) continue;
    AxisEdges& a = axis_[i];
    a.edges = 0;
    if ((latched_ & bit(i)) == 0) {
      touch_.latched[i] = {};
      continue;
    }
    touch_.latched[i] = a.latched;
    last_edge_ns_ = a.edge_ns;
    any_yet_ = true;
  }
  counted_ = latched_ = 0;
  cycles_open_ = 0;
}

}  // namespace volcomp
