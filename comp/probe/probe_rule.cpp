#include "comp/probe/probe_rule.hpp"

#include <cmath>

#include "comp/machine/machine_limits.hpp"

namespace volcomp {
namespace {

// Looks at numbers, group by group, until one is refused.
struct ProbeCheck {
  ProbeRefusal found{};

  // Each within ±most; uncertainties and delays not below 0.
  void look(const double* first, std::size_t count, ProbeSetting setting, double most) {
    if (found.reason != Reason::ok) return;
    Reason reason = check_numbers(first, count, most);
    if (reason == Reason::bound_exceeded) reason = Reason::bad_setting;
    const bool from_zero = setting == ProbeSetting::uncertainty || setting == ProbeSetting::delay ||
                           setting == ProbeSetting::latch_delay;
    for (std::size_t i = 0; from_zero && reason == Reason::ok && i < count; ++i) {
      if (first[i] < 0.0) reason = Reason::bad_setting;
    }
    if (reason != Reason::ok) found = {reason, setting};
  }
};

}  // namespace

ProbeRefusal check_probe_settings(const ProbeSettings& s) {
  const ProbeUncertainty& u = s.uncertainty;
  const std::array<double, 6> single{u.radius, u.tool_length, u.repeatability,
                                     u.tables, u.normal,      u.probe_delay_s};
  const auto& radius = s.radius.coefficient;
  ProbeCheck check;
  check.look(single.data(), single.size(), ProbeSetting::uncertainty, kMaxPart_nm);
  check.look(u.position.data(), kMaxAxes, ProbeSetting::uncertainty, kMaxPart_nm);
  check.look(u.latch_delay_s.data(), kMaxAxes, ProbeSetting::uncertainty, kMaxPart_nm);
  check.look(&u.correlation, 1, ProbeSetting::correlation, 1.0);
  check.look(radius.data(), kLobingTerms, ProbeSetting::radius, kMaxBallRadius_nm);
  check.look(s.workpiece.t.data(), 3, ProbeSetting::translation, kMaxPart_nm);
  check.look(s.workpiece.R.data(), 9, ProbeSetting::rotation, kMaxPart_nm);
  check.look(&s.probe_delay_s, 1, ProbeSetting::delay, kMaxProbeDelay_s);
  check.look(s.latch_delay_s.data(), kMaxAxes, ProbeSetting::latch_delay, kMaxProbeDelay_s);
  if (check.found.reason != Reason::ok) return check.found;
  if (radius[0] < 0.0) return {Reason::bad_setting, ProbeSetting::radius};
  if (!is_rotation(s.workpiece.R)) return {Reason::not_a_rotation, ProbeSetting::rotation};
  return {};
}

Reason check_normal(const Vec3& normal) {
  const double square = normal.squaredNorm();
  if (check_numbers(&square, 1, kMaxPart_nm) == Reason::not_finite) return Reason::not_finite;
  const bool unit = std::abs(square - 1.0) < 1e-9;
  return unit || square <= 0.0 ? Reason::ok : Reason::bad_setting;
}

}  // namespace volcomp
