// The probe of volcomp.h.

#include <algorithm>
#include <cmath>

#include "firmware/embed/c/compensator.hpp"

namespace {

using volcomp::Direction;
using volcomp::TouchVerdict;
using volcomp::Vec3;
using volcomp::c_interface::fine;
using volcomp::c_interface::from;
using volcomp::c_interface::refused;

// Together less than a turn: the chain allows half a turn beside that of a latched position.
constexpr double kMostDelay_s = 0.05;
constexpr double kMostVelocity = 1e13;  // units per second: 10 km, or nine turns
static_assert(2.0 * kMostDelay_s * kMostVelocity < static_cast<double>(volcomp::kUnitsPerTurn));
static_assert(static_cast<double>(volcomp::kMaxPosition) + 2.0 * kMostDelay_s * kMostVelocity <
              volcomp::kMaxContact_nm);

static_assert(volcomp::kLobingTerms == VOLCOMP_RADIUS_TERMS);
static_assert(static_cast<int>(Direction::forward) == VOLCOMP_FORWARD);
static_assert(static_cast<int>(Direction::backward) == VOLCOMP_BACKWARD);
static_assert(static_cast<int>(Direction::unknown) == VOLCOMP_UNKNOWN);

bool finite(volcomp::Span<const double> values) {
  for (const double v : values) {  // NOLINT(readability-use-anyofallof) the library unrolls it
    if (!std::isfinite(v)) return false;
  }
  return true;
}

bool within(volcomp::Span<const double> values, double most) {
  for (const double v : values) {  // NOLINT(readability-use-anyofallof)
    if (!(v <= most && v >= -most)) return false;
  }
  return true;
}

template <std::size_t N>
volcomp::Span<const double> all(const double (&values)[N]) {  // NOLINT(modernize-avoid-c-arrays)
  return {&values[0], N};
}

volcomp::Mat3 rotation_of(const volcomp_probe_settings& s) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(s.rotation);
}

volcomp_status check(const volcomp_probe_settings& s) {
  const volcomp_probe_uncertainty& u = s.uncertainty;
  const std::array<double, 7> single{u.radius, u.tool_length, u.correlation, u.repeatability,
                                     u.tables, u.normal,      u.delay_s};
  if (!finite(single) || !finite(all(u.position)) || !finite(all(u.latch_delay_s)))
    return refused(VOLCOMP_NOT_FINITE, "uncertainty");
  if (!finite(all(s.radius))) return refused(VOLCOMP_NOT_FINITE, "radius");
  if (!finite(all(s.rotation))) return refused(VOLCOMP_NOT_FINITE, "rotation");
  if (!finite(all(s.translation))) return refused(VOLCOMP_NOT_FINITE, "translation");
  if (!within({&s.delay_s, 1}, kMostDelay_s)) return refused(VOLCOMP_BAD_SETTING, "delay");
  if (!within(all(s.latch_delay_s), kMostDelay_s))
    return refused(VOLCOMP_BAD_SETTING, "latch delay");
  if (s.radius[0] < 0.0 || !within(all(s.radius), volcomp::kMaxBallRadius_nm))
    return refused(VOLCOMP_BAD_SETTING, "radius");
  if (!within(all(s.translation), volcomp::kMaxPart_nm))
    return refused(VOLCOMP_BAD_SETTING, "translation");
  if (!within(single, volcomp::kMaxPart_nm) || !within(all(u.position), volcomp::kMaxPart_nm) ||
      !within(all(u.latch_delay_s), volcomp::kMaxPart_nm))
    return refused(VOLCOMP_BAD_SETTING, "uncertainty");
  if (!within({&u.correlation, 1}, 1.0)) return refused(VOLCOMP_BAD_SETTING, "correlation");
  if (!volcomp::is_rotation(rotation_of(s))) return refused(VOLCOMP_NOT_A_ROTATION, "rotation");
  return fine();
}

volcomp::ProbeSettings settings_of(const volcomp_probe_settings& from) {
  volcomp::ProbeSettings s;
  s.probe_delay_s = from.delay_s;
  std::copy_n(from.radius, VOLCOMP_RADIUS_TERMS, s.radius.coefficient.begin());
  s.workpiece.R = rotation_of(from);
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
    if (!within({&l.velocity, 1}, kMostVelocity))
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
  if (!finite(all(from.normal))) return refused(VOLCOMP_NOT_FINITE, "normal");
  const Vec3 n(from.normal[0], from.normal[1], from.normal[2]);
  const double square = n.squaredNorm();
  const bool unit = std::abs(square - 1.0) < 1e-9;
  if (!unit && !(square <= 0.0)) return refused(VOLCOMP_BAD_SETTING, "normal");
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
  const volcomp_status status = check(*settings);
  if (status.reason == VOLCOMP_OK) c->probe.settings = settings_of(*settings);
  return status;
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
