// Cases of identification: chain, error functions, observations with their derivatives, centres of
// touched spheres, datum.

#include "host_sim/host/measure/identify/datum.hpp"
#include "host_sim/host/measure/identify/error_function.hpp"
#include "host_sim/host/measure/identify/observation.hpp"
#include "host_sim/host/measure/identify/touch_centre.hpp"
#include "host_sim/host/measure/identify/volume.hpp"
#include "tests/cases/handlers.hpp"
#include "tests/cases/id_case.hpp"

namespace volcomp::cases {
namespace {

using namespace host::identify;

template <class Matrix>
json rows_json(const Matrix& m) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      row.push_back(m(i, j));
    rows.push_back(row);
  }
  return rows;
}

template <class Row>
json row_json(const Row& r) {
  json row = json::array();
  for (Eigen::Index j = 0; j < r.size(); ++j)
    row.push_back(r(j));
  return row;
}

json chain(const json& in) {
  const Machine machine = machine_of(in.at("machine"));
  const Vec3 P = vector3(in.at("P"));
  json out = {{"point", json::array()},
              {"ideal", json::array()},
              {"G", json::array()},
              {"O", json::array()},
              {"R_wt", json::array()}};
  for (std::size_t i = 0; i < in.at("q").size(); ++i) {
    const Pose q = pose_of(in["q"][i]);
    const ChainGeometry g = ideal_geometry(machine.chain, q);
    out["point"].push_back(
        to_json(actual_tips(machine.chain, q, errors_of(in.at("errors")[i])).in_work(P)));
    out["ideal"].push_back(to_json(g.in_work(P)));
    out["R_wt"].push_back(rows_json(g.tool_in_work()));
    json G = json::array();
    json O = json::array();
    for (std::size_t a = 0; a < machine.chain.axis_count(); ++a) {
      const ErrorEffect point = g.work.R.transpose() * point_effect(g, a, g.tool.apply(P));
      const ErrorEffect turn = g.work.R.transpose() * turn_effect(g, a);
      G.push_back(rows_json(point));
      O.push_back(rows_json(turn));
    }
    out["G"].push_back(G);
    out["O"].push_back(O);
  }
  return out;
}

json function(const json& in) {
  const FunctionBasis f(number(in.at("lo")), number(in.at("hi")), in.at("periodic").get<bool>(),
                        in.at("segments").get<std::size_t>());
  const std::vector<double> c = numbers(in.at("coefficients"));
  const auto value = [&](double q) {
    double sum = 0.0;
    for (const BasisPiece& piece : f.at(q))
      sum += piece.value * c.at(piece.coefficient);
    return sum;
  };
  json out = {{"basis", json::array()}, {"value", json::array()}};
  for (const double q : numbers(in.at("q"))) {
    std::vector<double> row(f.size(), 0.0);
    for (const BasisPiece& piece : f.at(q))
      row.at(piece.coefficient) += piece.value;
    out["basis"].push_back(row);
    out["value"].push_back(value(q));
  }
  double slope = 0.0;
  const std::vector<double> samples = f.samples();
  const std::vector<double> weights = f.slope_weights();
  for (std::size_t k = 0; k < samples.size(); ++k)
    slope += weights[k] * value(samples[k]);
  if (!in.at("periodic").get<bool>()) out["slope"] = slope;
  return out;
}

// A problem of one set-up, and the circumstances of each of its observations.
class ObservationCase {
 public:
  explicit ObservationCase(const json& in) : in_(in) {
    problem_.machine = machine_of(in.at("machine"));
    for (const json& s : in.at("styli"))
      problem_.styli.push_back(stylus_of(s));
    json setup = in.at("setup");
    problem_.setups.push_back(setup_of(problem_.machine, setup));
  }

  [[nodiscard]] const SetUp& setup() const { return problem_.setups[0]; }
  [[nodiscard]] std::size_t axes() const { return problem_.machine.chain.axis_count(); }
  [[nodiscard]] std::size_t styli() const { return problem_.styli.size(); }
  [[nodiscard]] std::size_t stylus(std::size_t i) const { return *problem_.stylus_of(setup(), i); }

  [[nodiscard]] std::vector<Reading> readings(std::size_t i, bool errors) const {
    const SetUp& s = setup();
    Circumstances at;
    at.q = s.q[i];
    if (errors) at.errors = errors_of(in_.at("errors").at(i));
    const json& stylus_json = in_.at("styli").at(stylus(i));
    at.tip = problem_.styli[stylus(i)].offset;
    if (stylus_json.contains("correction")) at.tip_correction = vector3(stylus_json["correction"]);
    at.tip_radius = problem_.styli[stylus(i)].radius;
    if (stylus_json.contains("radius_correction"))
      at.tip_radius += number(stylus_json["radius_correction"]);
    at.kappa = number(in_.at("kappa"));
    at.local = numbers(in_.at("local"));
    if (s.has_pose()) {
      const json& artefact = in_.at("artefact");
      at.sphere = vector3(artefact.at("spheres").at(s.sphere[i]));
      at.sphere_correction = vector3(artefact.at("correction").at(s.sphere[i]));
      at.sphere_radius =
          number(artefact.at("radius").is_array() ? artefact["radius"].at(s.sphere[i])
                                                  : artefact["radius"]);
      at.placement = {exponential({at.local[0], at.local[1], at.local[2]}) * s.pose->R,
                      {at.local[3], at.local[4], at.local[5]}};
    }
    return reading_of(problem_, s, at);
  }

 private:
  const json& in_;
  Problem problem_;
};

json observation(const json& in) {
  const ObservationCase c(in);
  json out = {{"y", json::array()},
              {"y_ideal", json::array()},
              {"de", json::array()},
              {"dlocal", json::array()}};
  const bool runs = c.setup().kind == ObservationKind::runs;
  const bool has_length = !runs && c.setup().kind != ObservationKind::rtest;
  for (std::size_t i = 0; i < c.setup().q.size(); ++i) {
    for (const Reading& r : c.readings(i, true))
      out["y"].push_back(r.y);
    for (const Reading& r : c.readings(i, false)) {
      out["y_ideal"].push_back(r.y);
      json de = json::array();
      for (std::size_t a = 0; a < c.axes(); ++a)
        de.push_back(row_json(r.by_error.at(a)));
      out["de"].push_back(de);
      out["dlocal"].push_back(row_json(r.by_local));
      if (has_length) out["dkappa"].push_back(r.by_kappa);
      for (std::size_t s = 0; s < c.styli() && !runs; ++s) {
        const Row3 by_tip = s == c.stylus(i) ? r.by_tip : Row3(Row3::Zero());
        const json& stylus = in.at("styli").at(s);
        if (!stylus.value("fixed", false))
          out["dstylus" + std::to_string(s)].push_back(row_json(by_tip));
      }
    }
  }
  return out;
}

json sphere(const json& in) {
  const Machine machine = machine_of(in.at("machine"));
  TouchedCentre found;
  require(touched_centre(machine.chain, vector3(in.at("P")), poses_of(in.at("q")), found));
  json q = json::array();
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a)
    q.push_back(found.q.at(a));
  json cofactors = json::array();
  for (Eigen::Index k = 0; k < 4; ++k)
    cofactors.push_back(found.fit.cofactors(k, k));
  return {{"centre", to_json(found.centre)},
          {"radius", found.fit.sphere.radius},
          {"q_centre", q},
          {"cofactors", cofactors},
          {"rms", found.fit.rms}};
}

json refine(const json& in) {
  const Machine machine = machine_of(in.at("machine"));
  std::vector<ErrorSet> errors;
  for (const json& e : in.at("errors"))
    errors.push_back(errors_of(e));
  Vec3 centre;
  require(refined_centre(machine.chain, vector3(in.at("P")), poses_of(in.at("q")), errors,
                         pose_of(in.at("q_centre")), errors_of(in.at("errors_centre")), centre));
  return {{"centre", to_json(centre)}};
}

json gauge(const json& in) {
  AxisSlopes slopes;
  for (std::size_t a = 0; a < 3; ++a)
    slopes.at(a) = vector3(in.at("slopes").at(a));
  const SquareDatum datum = square_datum(slopes);
  json after = json::array();
  for (const Vec3& axis : datum.after)
    after.push_back(to_json(axis));
  return {{"rotation", to_json(datum.rotation)},
          {"slopes_after", after},
          {"a_xy_xz_yz", {datum.a_xy, datum.a_xz, datum.a_yz}}};
}

json rigid(const json& in) {
  std::vector<Vec3> points;
  std::vector<Vec3> errors;
  for (const json& p : in.at("points"))
    points.push_back(vector3(p));
  for (const json& e : in.at("errors"))
    errors.push_back(vector3(e));
  json after = json::array();
  for (const Vec3& e : without_rigid(points, errors))
    after.push_back(to_json(e));
  return {{"after", after}};
}

}  // namespace

void add_id_geometry(Handlers& handlers) {
  handlers["id.chain"] = chain;
  handlers["id.function"] = function;
  handlers["id.observation"] = observation;
  handlers["id.sphere"] = sphere;
  handlers["id.refine"] = refine;
  handlers["id.gauge"] = gauge;
  handlers["id.rigid"] = rigid;
}

}  // namespace volcomp::cases
