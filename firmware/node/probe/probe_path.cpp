#include "firmware/node/probe/probe_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "comp/probe/probe_rule.hpp"
#include "firmware/node/arrivals.hpp"
#include "firmware/node/wire_scale.hpp"

namespace volcomp::node {
namespace {

constexpr double kSecondsPerNs = 1e-9;
// No cycle is shorter: target and offset of one axis take 250 us of a bus at 1 Mbit/s. With shorter
// periods any difference is a speed beyond kMaxContact_nm in what 2300h:02 and 2301h may add up to.
constexpr std::uint32_t kLeastPeriod_us = 250;
static_assert(0x1p31 * kMostScale * (1.0 + 2.0 * kMaxProbeDelay_ns / (1000.0 * kLeastPeriod_us)) <
              kMaxContact_nm);

Frame frame_of(const std::array<double, 12>& v) {
  Frame frame;
  const double* next = v.data();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      frame.R(r, c) = *next++;
  }
  for (int r = 0; r < 3; ++r)
    frame.t[r] = *next++;
  return frame;
}

// Half a period either way, all of it equally likely (JCGM 100, 4.3.7), beside what is known.
double with_unknown_time(double delay_s, std::uint32_t period_us) {
  const double half_s = 0.5e-6 * period_us;
  const double variance = delay_s * delay_s + half_s * half_s / 3.0;
  return static_cast<double>(std::sqrt(static_cast<float>(variance)));
}

ProbeSettings settings_of(const ProbeObjects& o) {
  ProbeSettings s;
  s.probe_delay_s = o.delay_ns * kSecondsPerNs;
  s.radius.coefficient = o.lobing;
  s.workpiece = frame_of(o.workpiece);
  ProbeUncertainty& u = s.uncertainty;
  u.radius = o.uncertainty[0];
  u.tool_length = o.uncertainty[1];
  u.correlation = o.uncertainty[2];
  u.repeatability = o.uncertainty[3];
  u.tables = o.uncertainty[4];
  u.normal = o.uncertainty[5];
  u.probe_delay_s = o.uncertainty[6] * kSecondsPerNs;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    s.latch_delay_s[a] = o.latch_delay_ns[a] * kSecondsPerNs;
    u.position[a] = o.position_uncertainty[a];
    u.latch_delay_s[a] = o.latch_delay_uncertainty_ns[a] * kSecondsPerNs;
  }
  return s;
}

std::int32_t saturated(std::int64_t nm) {
  return static_cast<std::int32_t>(
      std::max<std::int64_t>(INT32_MIN, std::min<std::int64_t>(INT32_MAX, nm)));
}

std::array<std::int32_t, 3> saturated(const std::array<std::int64_t, 3>& nm) {
  return {saturated(nm[0]), saturated(nm[1]), saturated(nm[2])};
}

std::uint32_t largest(const std::array<float, 3>& nm) {
  const float most = std::max(nm[0], std::max(nm[1], nm[2]));
  return most < 4e9F ? static_cast<std::uint32_t>(most) + 1U : UINT32_MAX;
}

}  // namespace

void ProbePath::reset() {
  on_ = has_machine_ = losing_ = false;
  feature_ = {};
  flank_.reset();
  points_.clear();
  collector_ = {};
  Touch forgotten;
  while (touches_.pop(forgotten)) {
  }
  overrun_ = 0;
}

// --- settings

void ProbePath::set_machine(const MachineDescription& machine) {
  corrector_.set_machine(machine);
  has_machine_ = true;
}

Status ProbePath::apply(std::uint32_t axes, std::uint32_t untimed, std::uint32_t period_us) {
  ProbeSettings settings = settings_of(objects_);
  // Without a cycle period the speed of an axis is unknown.
  const Reason reason =
      period_us < kLeastPeriod_us ? Reason::bad_setting : check_probe_settings(settings).reason;
  objects_.reason = static_cast<std::uint8_t>(reason);
  if (reason != Reason::ok) return refuse(reason);
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    double& delay_s = settings.uncertainty.latch_delay_s[a];
    if ((untimed & bit(a)) != 0) delay_s = with_unknown_time(delay_s, period_us);
  }
  corrector_.settings = settings;
  TouchRules rules;
  rules.axes = axes;
  rules.untimed = untimed;
  rules.period_ns = std::int64_t{period_us} * 1000;
  rules.bounce_ns = std::int64_t{objects_.bounce_us} * 1000;
  rules.skew_ns = objects_.skew_ns;
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    rules.delay_ns[a] = objects_.latch_delay_ns[a];
  collector_.configure(rules);
  on_ = true;
  return {};
}

Reason ProbePath::take_feature(std::uint32_t index) {
  const Vec3 n(objects_.normal[0], objects_.normal[1], objects_.normal[2]);
  if (const Reason reason = check_normal(n); reason != Reason::ok) return reason;
  if (const Reason reason = flank_.take(); reason != Reason::ok) return reason;
  feature_ = {index, flank_.announced() ? Vec3::Zero() : n};
  return Reason::ok;
}

// --- tick

void ProbePath::end_cycle() {
  const Touch* const touch = collector_.finish_cycle();
  if (touch != nullptr && !touches_.push(*touch)) ++overrun_;
}

// --- background

ProbePoint ProbePath::point_of(const Touch& touch, JudgedTouch& judged) const {
  const Preemptible preemptible(preemption_);
  ProbePoint point;
  if (has_machine_ && accepted(touch.verdict))
    point = corrector_.correct(touch, feature_, compensator_.error_at(touch.latched));
  point.sequence = touch.sequence;
  point.feature = feature_.index;
  point.axis = touch.axis;
  if (!accepted(touch.verdict)) point.verdict = touch.verdict;
  if (!has_machine_) point.verdict = TouchVerdict::no_machine;
  if (!accepted(point.verdict))
    point.machine = point.workpiece = {};
  else if (flank_.announced())
    judged = flank_.judge(saturated(point.workpiece));
  return point;
}

bool ProbePath::work() {
  objects_.lost += std::exchange(overrun_, 0);
  if (touches_.empty()) return false;
  if (compensator_.pending()) return false;  // the tables of the point must stay while it is made
  Touch touch;
  touches_.pop(touch);
  JudgedTouch judged;
  last_ = point_of(touch, judged);
  publish(last_, touch, judged);
  return true;
}

void ProbePath::publish(const ProbePoint& point, const Touch& touch, const JudgedTouch& judged) {
  ++objects_.touches;
  if (!accepted(point.verdict)) ++objects_.rejected;
  losing_ = !points_.push(encode_point(point, touch, judged));
  if (losing_) ++objects_.lost;
  released();
  objects_.sequence = point.sequence;
  objects_.verdict = static_cast<std::uint8_t>(point.verdict);
  objects_.axis =
      accepted(point.verdict) ? std::uint8_t{0} : static_cast<std::uint8_t>(point.axis + 1);
  objects_.feature_low = static_cast<std::uint16_t>(point.feature);
  objects_.workpiece_nm = saturated(point.workpiece);
  objects_.machine_nm = point.machine;
  objects_.uncertainty_nm = largest(point.uncertainty);
  if (judged.flank.gear != 0) publish(judged, point.sequence);
}

void ProbePath::publish(const JudgedTouch& judged, std::uint32_t sequence) {
  objects_.distance_nm = distance_nm(judged.touch.distance);
  objects_.flank_verdict = static_cast<std::uint8_t>(judged.touch.verdict);
  objects_.foot = static_cast<std::uint8_t>(judged.touch.foot.reason);
  objects_.judged = sequence;
}

void ProbePath::released() { objects_.waiting = static_cast<std::uint16_t>(points_.waiting()); }

}  // namespace volcomp::node
