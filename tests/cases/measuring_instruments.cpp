// Cases of instruments and of the figures of ISO 230-2.

#include <algorithm>
#include <cmath>

#include "comp/metrology/tables/iso230.hpp"
#include "host_sim/sim/instruments/drift.hpp"
#include "host_sim/sim/instruments/touch_noise.hpp"
#include "tests/cases/handlers.hpp"

namespace volcomp::cases {
namespace {

json probe(const json& in) {
  const json& p = in.at("probe");
  sim::TouchNoise noise;
  noise.repeatability_2s = number(p.at("repeatability_2s_um")) * kUm;
  noise.stylus = number(p.at("stylus_mm"));
  noise.lobe3 = number(p.at("lobe3_um")) * kUm;
  noise.lobe3_angle = number(p.at("lobe3_rad"));
  noise.hysteresis = number(p.at("hysteresis_um")) * kUm;
  noise.force_xy = number(p.at("force_xy_N"));
  noise.force_z = number(p.at("force_z_N"));
  noise.stiffness_xy = number(p.at("stiffness_xy_N_per_um")) / kUm;
  noise.stiffness_z = number(p.at("stiffness_z_N_per_um")) / kUm;
  const Vec3 normal = vector3(in.at("normal"));
  const Vec3 before = in.at("previous").is_null() ? Vec3::Zero() : vector3(in["previous"]);
  return {{"lobing_um", noise.lobing(normal) / kUm},
          {"bending_um", noise.bending(normal) / kUm},
          {"hysteresis_um", noise.lag(normal, before) / kUm},
          {"sigma_um", noise.sigma() / kUm},
          {"total_um", noise.of_touch(normal, before, number(in.at("z"))) / kUm}};
}

json drift(const json& in) {
  const auto kind = in.at("kind").get<std::string>();
  sim::Drift d;
  d.kind = kind == "walk"       ? sim::DriftKind::walk
           : kind == "ornstein" ? sim::DriftKind::ornstein
                                : sim::DriftKind::exponential;
  d.size = number(in.at("size_um")) * kUm;
  d.tau = number(in.at("tau_s"));
  std::vector<double> out = d.at(numbers(in.at("times_s")), numbers(in.at("z")));
  for (double& value : out)
    value /= kUm;
  return {{"drift_um", out}};
}

// Mean and standard deviation per target of one direction.
struct Direction {
  std::vector<double> mean, deviation;

  explicit Direction(const json& runs) {
    const auto n = static_cast<double>(runs.size());
    for (std::size_t i = 0; i < runs.at(0).size(); ++i) {
      double sum = 0.0;
      double squares = 0.0;
      for (const json& run : runs)
        sum += number(run.at(i)) / n;
      for (const json& run : runs)
        squares += std::pow(number(run[i]) - sum, 2);
      mean.push_back(sum);
      deviation.push_back(std::sqrt(squares / (n - 1.0)));
    }
  }
  [[nodiscard]] DirectionStatistics statistics() const { return {mean, deviation}; }
  [[nodiscard]] double range() const {
    const auto [least, most] = std::minmax_element(mean.begin(), mean.end());
    return *most - *least;
  }
};

json iso230_2(const json& in) {
  const Direction up(in.at("up"));
  const Direction down(in.at("down"));
  Iso230Figures f;
  require(iso230_figures(up.statistics(), down.statistics(), f));
  json out = {{"mean_up", up.mean},
              {"mean_down", down.mean},
              {"s_up", up.deviation},
              {"s_down", down.deviation},
              {"B", f.B},
              {"M", f.M},
              {"E", f.E},
              {"E_up", up.range()},
              {"E_down", down.range()},
              {"R", f.R},
              {"R_up", f.R_up},
              {"R_down", f.R_down},
              {"A", f.A},
              {"A_up", f.A_up},
              {"A_down", f.A_down}};
  double mean_reversal = 0.0;
  for (std::size_t i = 0; i < up.mean.size(); ++i) {
    const double B = up.mean[i] - down.mean[i];
    const double both = 2.0 * (up.deviation[i] + down.deviation[i]) + std::abs(B);
    out["B_i"].push_back(B);
    out["mean"].push_back(0.5 * (up.mean[i] + down.mean[i]));
    out["R_i"].push_back(std::max({both, 4.0 * up.deviation[i], 4.0 * down.deviation[i]}));
    mean_reversal += B / static_cast<double>(up.mean.size());
  }
  out["B_mean"] = mean_reversal;
  return out;
}

}  // namespace

void add_measuring_instruments(Handlers& handlers) {
  handlers["me.probe"] = probe;
  handlers["me.drift"] = drift;
  handlers["me.iso230_2"] = iso230_2;
}

}  // namespace volcomp::cases
