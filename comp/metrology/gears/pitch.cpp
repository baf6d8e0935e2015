#include "comp/metrology/gears/pitch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace volcomp {
namespace {

Status too_few(std::size_t count) {
  Where where;
  where.count = static_cast<int>(count);
  return refuse(Reason::too_few_points, where);
}

std::size_t missing_of(Span<const double> position) {
  std::size_t missing = 0;
  for (const double p : position)
    missing += std::isnan(p) ? 1U : 0U;
  return missing;
}

// Gaps are no values; infinite values are no gaps.
Status check_values(Span<const double> position) {
  if (position.size() < 2) return too_few(position.size());
  for (std::size_t k = 0; k < position.size(); ++k) {
    Where where;
    where.index = static_cast<int>(k);
    if (std::isinf(position[k])) return refuse(Reason::not_finite, where);
  }
  return {};
}

Status check_round(Span<const double> position) {
  if (position.size() < 2) return too_few(position.size());
  Where where;
  where.count = static_cast<int>(missing_of(position));
  for (std::size_t k = position.size(); k > 0; --k) {
    if (std::isnan(position[k - 1])) where.index = static_cast<int>(k - 1);
  }
  if (where.count > 0) return refuse(Reason::incomplete, where);
  return check_values(position);
}

double before(Span<const double> position, std::size_t k) {
  return position[k == 0 ? position.size() - 1 : k - 1];
}

}  // namespace

Status ToothAngles::of(int teeth, ToothAngles& out) {
  if (teeth < 2 || teeth > static_cast<int>(kMaxPitchTeeth))
    return refuse_value(Reason::bad_setting, "teeth", teeth);
  out.teeth_ = static_cast<std::size_t>(teeth);
  out.angle_.fill(std::numeric_limits<double>::quiet_NaN());
  return {};
}

Status ToothAngles::record(int tooth, int side, double deviation, double moment_arm) {
  if (tooth < 0 || tooth >= static_cast<int>(teeth_))
    return refuse_value(Reason::bad_setting, "tooth", tooth);
  if (side != 1 && side != -1) return refuse_value(Reason::bad_setting, "side", side);
  if (!(moment_arm > 0.0 && std::isfinite(moment_arm)))
    return refuse_value(Reason::bad_setting, "moment_arm", moment_arm);
  if (!std::isfinite(deviation)) return refuse(Reason::not_finite);
  angle_[static_cast<std::size_t>(tooth)] = -side * deviation / moment_arm;
  return {};
}

Status evaluate_pitch(Span<const double> position, PitchDeviations& out, double scale) {
  if (const Status s = check_round(position); !s.ok()) return s;
  PitchDeviations d;
  double low = position[0];
  double high = position[0];
  for (std::size_t k = 0; k < position.size(); ++k) {
    low = std::min(low, position[k]);
    high = std::max(high, position[k]);
    const double single = scale * (position[k] - before(position, k));
    if (std::abs(single) <= d.single) continue;
    d.single = std::abs(single);
    d.single_signed = single;
    d.tooth = k;
  }
  d.total = scale * (high - low);
  out = d;
  return {};
}

Status single_pitches(Span<const double> position, Span<double> out, double scale) {
  if (const Status s = check_values(position); !s.ok()) return s;
  if (out.size() != position.size()) return refuse(Reason::length_mismatch);
  for (std::size_t k = 0; k < position.size(); ++k)
    out[k] = scale * (position[k] - before(position, k));
  return {};
}

Status cumulative_pitch(Span<const double> position, std::size_t k, double& out, double scale) {
  if (const Status s = check_round(position); !s.ok()) return s;
  if (k < 1 || k >= position.size())
    return refuse_value(Reason::bad_setting, "k", static_cast<double>(k));
  double largest = 0.0;
  for (std::size_t start = 0; start < position.size(); ++start) {
    const std::size_t end = (start + k) % position.size();
    largest = std::max(largest, std::abs(position[end] - position[start]));
  }
  out = scale * largest;
  return {};
}

Status evaluate_partial_pitch(Span<const double> position, PartialPitch& out, double scale) {
  if (const Status s = check_values(position); !s.ok()) return s;
  PartialPitch p;
  for (std::size_t k = 0; k < position.size(); ++k) {
    const double single = scale * (position[k] - before(position, k));
    if (std::isnan(single)) continue;
    ++p.pitches;
    if (std::abs(single) <= p.single) continue;
    p.single = std::abs(single);
    p.single_signed = single;
    p.tooth = k;
  }
  if (p.pitches == 0) return too_few(0);
  p.missing = missing_of(position);
  p.no_total = p.missing == 0 ? Reason::ok : Reason::partial;
  out = p;
  return {};
}

}  // namespace volcomp
