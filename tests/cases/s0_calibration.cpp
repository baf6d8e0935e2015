// Cases of docs/papers/l300g.md: circles through probe readings, error motions from targets, the
// printed procedure.

#include "comp/metrology/fits/circle_fit.hpp"
#include "comp/metrology/fits/printed_procedure.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/s0_case.hpp"
#include "tests/oracle/axis_identification.hpp"

namespace volcomp::cases {
namespace {

json three_of(const Circle& c) { return {c.y, c.z, c.radius}; }

json circle_fit(const json& in) {
  const std::vector<double> y = numbers(in.at("Y"));
  const std::vector<double> z = numbers(in.at("Z"));
  CircleFit fit;
  require(fit_circle(y, z, fit));
  return {{"kasa", three_of(fit.kasa)},
          {"pratt", three_of(fit.pratt)},
          {"taubin", three_of(fit.taubin)},
          {"geometric", three_of(fit.geometric)},
          {"geo_cov_over_sigma2", rows_of(fit.cofactors)},
          {"rms", fit.rms},
          {"n", y.size()}};
}

json identify(const json& in) {
  const Frame parent{matrix(in.at("parent_R")), vector3(in.at("parent_t"))};
  const Joint joint = joint_of(in.at("joint"));
  const double q = number(in.at("q"));
  std::vector<Vec3> position;
  std::vector<Vec3> displacement;
  for (std::size_t k = 0; k < in.at("targets").size(); ++k) {
    position.push_back(vector3(in.at("targets").at(k)));
    displacement.push_back(
        displacement_of(parent, joint, q, vector3(in.at("measured").at(k)), position.back()));
  }
  RigidFit fit;
  require(fit_rigid(position, displacement, fit));
  const Eigen::Matrix<double, 6, 1> variance = fit.cofactors.diagonal();
  return {{"delta", to_json(translation(fit.motion))},
          {"eps", to_json(rotation(fit.motion))},
          {"cov_delta_over_sigma2", to_json(Vec3(variance.head<3>()))},
          {"cov_eps_over_sigma2", to_json(Vec3(variance.tail<3>()))},
          {"rank", 6},
          {"cond_centred_scaled", fit.condition},
          {"rms", fit.rms}};
}

// --- one axis after the other

constexpr std::array<const char*, 4> kOrder{"X", "Y", "B", "A"};

struct Identified {
  std::vector<double> nodes;
  std::vector<ErrorMotion> motion;

  [[nodiscard]] ErrorMotion at(double q) const {
    bool held = false;
    return interpolate_motion(nodes, motion, q, held);
  }
};

class Successive {
 public:
  explicit Successive(const json& in) : machine_(in.at("machine")) {
    for (std::size_t a = 0; a < 4; ++a)
      ref_[a] = number(in.at("ref").at(kOrder[a]));
    for (const json& t : in.at("targets"))
      target_.push_back(vector3(t));
    for (std::size_t a = 0; a < 4; ++a)
      identify(a, in);
  }

  [[nodiscard]] ErrorSet errors_at(const Pose& q) const {
    ErrorSet set = zero_errors();
    for (std::size_t a = 0; a < 4; ++a) {
      if (!axis_[a].nodes.empty()) set[a] = axis_[a].at(q[a]);
    }
    return set;
  }
  [[nodiscard]] const Identified& axis(std::size_t a) const { return axis_[a]; }
  [[nodiscard]] const MachineChain& chain() const { return machine_.chain; }

 private:
  void identify(std::size_t a, const json& in) {
    Identified found;
    found.nodes = numbers(in.at("nodes").at(kOrder[a]));
    std::vector<Vec3> measured;
    for (const json& node : in.at("measured").at(kOrder[a])) {
      for (const json& m : node)
        measured.push_back(vector3(m));
    }
    const bool work = a == 3;
    const Frame parent =
        actual_frame(machine_.chain, work ? machine_.chain.work() : machine_.chain.tool(),
                     work ? 0 : a, ref_, errors_at(ref_));
    found.motion.resize(found.nodes.size());
    require(identify_axis(parent, machine_.chain.axis(a), {found.nodes, target_, measured},
                          found.motion));
    axis_[a] = found;
  }

  L300gCase machine_;
  Pose ref_{};
  std::vector<Vec3> target_;
  std::array<Identified, 4> axis_;
};

json successive(const json& in) {
  const Successive found(in);
  json out;
  for (std::size_t a = 0; a < 4; ++a) {
    for (const ErrorMotion& m : found.axis(a).motion) {
      out["tables_delta"][kOrder[a]].push_back(to_json(translation(m)));
      out["tables_eps"][kOrder[a]].push_back(to_json(rotation(m)));
    }
  }
  const MachineChain& chain = found.chain();
  for (const json& check : in.at("check_q")) {
    Pose q{};
    for (std::size_t a = 0; a < 4; ++a)
      q[a] = number(check.at(a));
    const PointPair points = ideal_points(chain, q, chain.tool_point());
    const VolumetricError e =
        exact_error(chain, q, found.errors_at(q), Vec3::Zero(), RotationModel::rxryrz, points);
    out["ideal"].push_back(to_json(points.work));
    out["corrected"].push_back(to_json(Vec3(points.work + e.position_work)));
  }
  return out;
}

// --- the paper's own way

json paper_table2(const json& in) {
  json out;
  std::vector<double> of_x;
  for (std::size_t a = 0; a < 4; ++a) {
    std::vector<double> difference;
    for (std::size_t i = 0; i < in.at("ideal").size(); ++i)
      difference.push_back(number(in.at("actual").at(i).at(a)) -
                           number(in.at("ideal").at(i).at(a)));
    if (a == 0) of_x = difference;
    ReadingFigures f;
    require(reading_figures(difference, f));
    out["mean"].push_back(f.mean);
    out["sd"].push_back(f.deviation);
    out["peak_to_peak"].push_back(f.range);
  }
  PrintedSolution solution;
  require(printed_x_solution(of_x, number(in.at("start").at(0)), solution));
  out["eq18_rank"] = solution.rank;
  out["eq18_min_norm_mm_rad"] = to_json(solution.least);
  out["r_c"] = number(in.at("R_c")) - number(in.at("R_mandrel"));
  return out;
}

}  // namespace

void add_s0_calibration(Handlers& handlers) {
  handlers["s0.circle_fit"] = circle_fit;
  handlers["s0.identify"] = identify;
  handlers["s0.successive"] = successive;
  handlers["s0.paper_table2"] = paper_table2;
}

}  // namespace volcomp::cases
