#include "comp/strokes/learning_choice.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp {
namespace {

struct NodeMean {
  double mean = 0.0;
  double variance_of_mean = 0.0;
};

NodeMean mean_of(const NodeSums& node) {
  const auto n = static_cast<double>(node.n);
  const double mean = node.sum / n;
  return {mean, std::max(node.sum_squares / n - mean * mean, 0.0) / n};
}

}  // namespace

Repeatability repeatability(Span<const NodeSums> nodes, std::uint32_t least_samples) {
  Repeatability r;
  double low = 0.0;
  double high = 0.0;
  double mean = 0.0;
  double squares = 0.0;  // of the means about their mean, Welford
  double noise = 0.0;    // sum of the variances of the means
  for (const NodeSums& node : nodes) {
    if (node.n == 0 || node.n < least_samples) continue;
    const NodeMean m = mean_of(node);
    low = r.nodes == 0 ? m.mean : std::min(low, m.mean);
    high = r.nodes == 0 ? m.mean : std::max(high, m.mean);
    ++r.nodes;
    const double off = m.mean - mean;
    mean += off / static_cast<double>(r.nodes);
    squares += off * (m.mean - mean);
    noise += m.variance_of_mean;
    r.noise = std::max(r.noise, std::sqrt(m.variance_of_mean));
  }
  r.amplitude = 0.5 * (high - low);
  const double total = squares + noise;
  r.ratio = total > 0.0 ? squares / total : 0.0;
  return r;
}

LearningVerdict judge_signal(const Repeatability& signal, double flank_per_unit,
                             double tolerance_um, double share) {
  constexpr double kSignificant = 3.0;
  constexpr double kLeastRatio = 0.5;
  if (!(flank_per_unit * signal.amplitude > share * tolerance_um))
    return LearningVerdict::too_small;
  if (!(signal.amplitude > kSignificant * signal.noise)) return LearningVerdict::not_significant;
  if (!(signal.ratio > kLeastRatio)) return LearningVerdict::not_repeatable;
  return LearningVerdict::compensate;
}

Status check_learning_target(LearningTarget target, bool both_follow_helix, bool forced,
                             double flank_per_rad, double turn_per_mm, double e_z, double e_c,
                             HelixEffect& prediction) {
  if (!std::isfinite(e_z) || !std::isfinite(e_c)) return refuse(Reason::not_finite);
  const double um_per_rad = kUmPerMm * flank_per_rad;
  prediction = {um_per_rad * turn_per_mm * e_z, um_per_rad * e_c,
                um_per_rad * (e_c + turn_per_mm * e_z)};
  const bool alone = target == LearningTarget::z_alone || target == LearningTarget::c_alone;
  if (!alone || !both_follow_helix || forced) return {};
  Where where;
  where.field = target == LearningTarget::z_alone ? "Z" : "C";
  where.value = target == LearningTarget::z_alone ? prediction.c_um : prediction.z_um;
  where.has_value = true;
  return refuse(Reason::breaks_helix, where);
}

FlankPairErrors errors_of_flank_pair(double dn_plus, double dn_minus, double flank_per_rad,
                                     double flank_per_x) {
  return {0.5 * (dn_plus - dn_minus) / flank_per_rad, -0.5 * (dn_plus + dn_minus) / flank_per_x};
}

}  // namespace volcomp
