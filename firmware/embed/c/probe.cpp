// The probe of volcomp.h.

#include <algorithm>
#include <cmath>

#include "comp/probe/probe_rule.hpp"
#include "firmware/embed/c/compensator.hpp"

namespace {

using volcomp::Direction;
using volcomp::TouchVerdict;
using volcomp::Vec3;
using volcomp::c_interface::code_of;
using volcomp::c_interface::fine;
using volcomp::c_interface::from;
using volcomp::c_interface::refused;

// In the longest delays less than a turn: the chain allows half a turn beside that of a latched
// position.
constexpr double kMostVelocity = 1e13;  // units per second: 10 km, or nine turns
constexpr double kMostWay = 2.0 * volcomp::kMaxProbeDelay_s * kMostVelocity;
static_assert(kMostWay < static_cast<double>(volcomp::kUnitsPerTurn));
static_assert(static_cast<double>(volcomp::kMaxPosition) + kMostWay < volcomp::kMaxContact_nm);

static_assert(volcomp::kLobingTerms == VOLCOMP_RADIUS_TERMS);
static_assert(static_cast<int>(Direction::forward) == VOLCOMP_FORWARD);
static_assert(static_cast<int>(Direction::backward) == VOLCOMP_BACKWARD);
static_assert(static_cast<int>(Direction::unknown) == VOLCOMP_UNKNOWN);

const char* name_of(volcomp::ProbeSetting setting) {
  constexpr std::array names{"",         "uncertainty", "correlation", "radius",
                             "rotation", "translation", "delay",       "latch delay"};
  return names[static_cast<std::size_t>(setting)];
}

volcomp::ProbeSettings settings_of(const volcomp_probe_settings& from) {
  volcomp::ProbeSettings s;
  s.probe_delay_s = from.delay_s;
  std::copy_n(from.radius, VOLCOMP_RADIUS_TERMS, s.radius.coefficient.begin());
  s.workpiece.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(from.rotation);
  s.workpiece.t = Eigen::Map<const Vec3>(from.translation);
  s.uncertainty.radius = from.uncertainty.radius;
  s.uncertainty.tool_length = from.uncertainty.tool_length;
  s.uncertainty.correlation = from.uncertainty.correlation;
  s.uncertainty.repeatability = from.uncertainty.repeatability;
  s.uncertainty.tables = from.uncertainty.tables;
  s.uncertainty.normal = from.uncertainty.normal;
  s.uncertainty.probe_delay_s = from.uncertainty.delay_s;
  for (std::size_t a = 0; a < VOLCOMP_AXES; ++a) {
    s.latch_delay_s[a] = from.latch_delay_s[a];
    s.uncertainty.position[a] = from.uncertainty.position[a];
    s.uncertainty.latch_delay_s[a] = from.uncertainty.latch_delay_s[a];
  }
  return s;
}

volcomp_status take_latches(const volcomp_touch& from, const volcomp_compensator& c,
                            volcomp::Touch& touch) {
  const volcomp::RuntimeChain& chain = c.compensator.machine().chain;
  for (std::size_t a = 0; a < chain.axes; ++a) {
    const volcomp_latch& l = from.axis[a];
    const int number = static_cast<int>(a);
    if (!std::isfinite(l.velocity)) return refused(VOLCOMP_NOT_FINITE, "velocity", number);
    if (std::abs(l.velocity) > kMostVelocity)
      return refused(VOLCOMP_BAD_SETTING, "velocity", number);
    if (l.direction < VOLCOMP_FORWARD || l.direction > VOLCOMP_UNKNOWN)
      return refused(VOLCOMP_BAD_SETTING, "direction", number);
    const bool rotary = chain.kind[a] == volcomp::JointKind::rotary;
    touch.latched[a] = {rotary ? l.position : volcomp::clamp_position(l.position), l.velocity,
                        static_cast<Direction>(l.direction)};
  }
  touch.sequence = from.sequence;
  return fine();
}

volcomp_status take_feature(const volcomp_feature& from, volcomp::ProbeFeature& feature) {
  const Vec3 n(from.normal[0], from.normal[1], from.normal[2]);
  if (const volcomp::Reason reason = volcomp::check_normal(n); reason != volcomp::Reason::ok)
    return refused(code_of(reason), "normal");
  feature = {from.index, n};
  return fine();
}

void put_out(const volcomp::ProbePoint& point, volcomp_point& out) {
  out = {};
  out.sequence = point.sequence;
  out.feature = point.feature;
  out.verdict = static_cast<int>(point.verdict);
  if (!accepted(point.verdict)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    out.machine[i] = point.machine[i];
    out.workpiece[i] = point.workpiece[i];
    out.uncertainty[i] = point.uncertainty[i];
  }
}

}  // namespace

void volcomp_default_probe_settings(volcomp_probe_settings* out) {
  *out = {};
  for (const std::size_t diagonal : {0U, 4U, 8U})
    out->rotation[diagonal] = 1.0;
}

volcomp_status volcomp_configure_probe(volcomp_compensator* c,
                                       const volcomp_probe_settings* settings) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (settings == nullptr) return refused(VOLCOMP_NULL_POINTER, "settings");
  const volcomp::ProbeSettings accepted = settings_of(*settings);
  const volcomp::ProbeRefusal refusal = check_probe_settings(accepted);
  if (refusal.reason != volcomp::Reason::ok)
    return refused(code_of(refusal.reason), name_of(refusal.setting));
  c->probe.settings = accepted;
  return fine();
}

volcomp_status volcomp_correct_touch(const volcomp_compensator* c, const volcomp_touch* touch,
                                     const volcomp_feature* feature, volcomp_point* out) {
  if (c == nullptr) return refused(VOLCOMP_NULL_POINTER, "compensator");
  if (touch == nullptr) return refused(VOLCOMP_NULL_POINTER, "touch");
  if (feature == nullptr) return refused(VOLCOMP_NULL_POINTER, "feature");
  if (out == nullptr) return refused(VOLCOMP_NULL_POINTER, "out");
  if (c->compensator.pending()) return from(refuse(volcomp::Reason::hand_over_pending));
  volcomp::Touch latched;
  volcomp::ProbeFeature touched;
  if (const volcomp_status s = take_latches(*touch, *c, latched); s.reason != VOLCOMP_OK) return s;
  if (const volcomp_status s = take_feature(*feature, touched); s.reason != VOLCOMP_OK) return s;
  volcomp::ProbePoint point;
  if (c->activated)
    point = c->probe.correct(latched, touched, c->compensator.error_at(latched.latched));
  else
    point.verdict = TouchVerdict::no_machine;
  point.sequence = latched.sequence;
  point.feature = touched.index;
  put_out(point, *out);
  return fine();
}
