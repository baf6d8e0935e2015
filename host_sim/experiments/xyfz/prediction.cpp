#include "host_sim/experiments/xyfz/prediction.hpp"

#include <algorithm>
#include <cmath>

namespace volcomp::xyfz {
namespace {

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

std::vector<double> along_pnp_um(const host::BuiltTables& tables, const DiagonalBox& box,
                                 std::size_t points) {
  const auto error_at = [&](const Vec3& p) -> Vec3 {
    return kUmPerMm *
           tables.model.first_order({p.x(), p.y(), p.z()}, kUnknownTravels, Beyond::stand_at_end);
  };
  std::vector<double> deviation(points);
  DiagonalFigures unused;
  host::require(diagonal_deviations(error_at, body_diagonals(box)[sim::kPnp],
                                    {deviation.data(), deviation.size()}, unused),
                "diagonal");
  return deviation;
}

}  // namespace

double Prediction::measured_max_um() const { return largest(measured_um); }

double Prediction::predicted_max_um(std::size_t model) const {
  return largest(predicted_um.at(model));
}

double Prediction::left_um(std::size_t model) const {
  std::vector<double> left = measured_um;
  for (std::size_t i = 0; i < left.size(); ++i)
    left[i] -= predicted_um.at(model)[i];
  return largest(left);
}

Prediction predict_pnp(const Bench& bench, CheckedCampaign& measured) {
  const sim::MeasuredDiagonal pnp = measured.pnp(bench, {});
  Prediction out;
  out.distance_mm = pnp.distance_mm;
  out.measured_um = pnp.mean_um;
  for (std::size_t m = 0; m < kModels.size(); ++m)
    out.predicted_um[m] =
        along_pnp_um(*host::build_tables(measured.campaign.machine, measured.campaign.runs,
                                         host::tables_only(kModels[m], bench.options.knots)),
                     bench.box, pnp.mean_um.size());
  return out;
}

}  // namespace volcomp::xyfz
