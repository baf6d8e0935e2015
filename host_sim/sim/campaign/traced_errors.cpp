#include "host_sim/sim/campaign/traced_errors.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/check.hpp"
#include "host_sim/host/measure/identify/identification.hpp"
#include "host_sim/host/measure/identify/planned_places.hpp"
#include "host_sim/host/measure/identify/volume.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"

namespace volcomp::sim {
namespace {

namespace identify = host::identify;

constexpr double kReflector_mm = 0.02;  // of each coordinate of a reflector, after a tool setter

identify::MeasurementPlan plan_of(const host::MachineFile& file, const TracedPlan& traced,
                                  double reading_mm) {
  identify::MeasurementPlan plan;
  plan.path = file.path;
  plan.machine = file;
  identify::Problem& problem = plan.problem;
  problem.machine = machine_of(file);
  problem.model = traced.model;
  problem.styli.push_back({"S0", file.chain.tool_point(), 0.0, {}, {}});
  for (const Vec3& way : traced.reflectors)
    problem.styli.push_back({fmt::format("S{}", problem.styli.size()),
                             file.chain.tool_point() + way,
                             0.0,
                             kReflector_mm,
                             {}});
  identify::PlaceChoice choice;
  choice.count = traced.places;
  for (std::size_t s = 0; s < problem.styli.size(); ++s)
    choice.tips.push_back(s);
  for (const Vec3& station : stations_about(problem.machine)) {
    identify::SetUp s;
    s.name = fmt::format("station {}", problem.setups.size() + 1);
    s.kind = identify::ObservationKind::tracer;
    s.station = station;
    s.station_prior = traced.station_mm;
    s.scale = kWavelength;
    s.growth = kSteel_per_K * kTracedGrowth_K;
    identify::add_planned_places(plan, choice, s);
    s.sigma.assign(s.q.size(), std::hypot(reading_mm, traced.repeatability_mm));
    problem.setups.push_back(std::move(s));
  }
  return plan;
}

void read_all(const TrueMachine& truth, const TracerScatter& scatter,
              identify::MeasurementPlan& plan) {
  ShopFloor floor;
  floor.perfect = scatter.perfect;
  floor.growth_K = kTracedGrowth_K;
  floor.stylus_mm = kReflector_mm;
  floor.seed = scatter.seed;
  floor.draw = scatter.draw;
  const PlanTruth shop = draw_plan_truth(plan.problem, truth, floor);
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k)
    read_instrument(plan, shop, k, plan.problem.setups[k]);
  if (scatter.perfect) return;
  // The estimate knows of the drift, though not how it goes.
  for (identify::SetUp& s : plan.problem.setups)
    for (double& sigma : s.sigma)
      sigma = std::hypot(sigma, tracer_drift_mm(floor, s.q.size()));
}

// Largest uncertainties at a few places of an axis, between them in a straight line.
std::vector<ErrorMotion> uncertainties(const identify::Equations& equations,
                                       const identify::Triangle& triangle, std::size_t axis,
                                       const std::vector<double>& at) {
  constexpr std::size_t kSteps = 13;
  const identify::Unknowns& unknowns = equations.unknowns();
  std::vector<ErrorMotion> known;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(kSteps - 1);
    const double q = at.front() + part * (at.back() - at.front());
    ErrorMotion u;
    for (Eigen::Index c = 0; c < 6; ++c) {
      identify::VectorXd row = identify::VectorXd::Zero(unknowns.size());
      unknowns.add_errors(axis, q, 0.0, identify::Row6::Unit(c), row);
      u(c) = triangle.uncertainty(row);
    }
    known.push_back(u);
  }
  std::vector<ErrorMotion> out;
  for (const double q : at) {
    const double place = (q - at.front()) / (at.back() - at.front()) * (kSteps - 1);
    const auto before = std::min(static_cast<std::size_t>(place), kSteps - 2);
    const double part = place - static_cast<double>(before);
    out.emplace_back((1.0 - part) * known[before] + part * known[before + 1]);
  }
  return out;
}

std::vector<host::ErrorCurves> curves_of(const host::MachineFile& file,
                                         const identify::Equations& equations,
                                         const identify::Solution& solution) {
  constexpr double kCoverage = 2.0;
  std::vector<host::ErrorCurves> curves;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    host::ErrorCurves c;
    c.letter = file.axes[a].letter;
    c.rotary = file.axes[a].rotary;
    c.at = file.axes[a].all_targets();
    for (const double q : c.at)
      c.value.push_back(equations.unknowns().error(a, q, 0.0, solution.estimate.x));
    for (const ErrorMotion& u : uncertainties(equations, solution.triangle, a, c.at))
      c.half_width.emplace_back(kCoverage * u);
    curves.push_back(std::move(c));
  }
  return curves;
}

std::vector<TracedValue> values_of(const identify::Equations& equations,
                                   const identify::Solution& solution) {
  std::vector<TracedValue> out;
  const identify::Values values(equations, solution.triangle, &solution.estimate.x);
  for (const identify::FoundValue& v : values.singles())
    out.push_back({v.quantity.name, v.quantity.angular(), v.value.value, v.value.u});
  return out;
}

// Places that no reading was taken at; as identified, before it is a table.
void compare(const TrueMachine& truth, const identify::Equations& equations,
             const identify::Solution& solution, TracedErrors& out) {
  constexpr std::size_t kCompared = 100;
  const identify::Machine& machine = equations.problem().machine;
  const Vec3 tool = machine.chain.tool_point();
  const auto error_of = [&](const Pose& q) {
    return exact_error(machine.chain, q, equations.unknowns().errors(q, {}, solution.estimate.x),
                       Vec3::Zero(), RotationModel::rxryrz, ideal_points(machine.chain, q, tool));
  };
  Pose reference{};
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a)
    reference.at(a) = machine.travel.at(a).reference;
  const auto turn_of = [&](const Pose& q) -> Vec3 {
    return identify::ideal_geometry(machine.chain, q).tool_in_work().transpose() *
           (error_of(q).orientation_work - truth.error(q, {}, tool).orientation_work);
  };
  std::vector<Pose> places = identify::places_of(machine, 10 * kCompared);
  places.erase(places.begin(), places.end() - static_cast<std::ptrdiff_t>(kCompared));
  const Vec3 turned = turn_of(reference);
  double squares = 0.0;
  for (const Pose& q : places) {
    const Vec3 off = error_of(q).position_work - truth.error(q, {}, tool).position_work;
    squares += off.squaredNorm() / kCompared;
    out.largest_mm = std::max(out.largest_mm, off.norm());
    out.largest_rad = std::max(out.largest_rad, (turn_of(q) - turned).norm());
  }
  out.rms_mm = std::sqrt(squares);
  double variance = 0.0;
  for (const double u :
       identify::volume_uncertainty(equations, solution.triangle, {places}, tool).datum)
    variance += u * u / kCompared;
  out.u_rms_mm = std::sqrt(variance);
}

}  // namespace

std::string scatter_text(const TracedPlan& plan, const TracerScatter& scatter) {
  if (scatter.perfect) return "neither its readings nor its stations scatter";
  return fmt::format(
      "its readings scatter by {:g} µm{}, all lengths of a station by {:g} ppm, it walks by {:g} "
      "µm "
      "in an hour; the places of its four stations scatter by {:g} µm, and at each the linear axes "
      "are warmer or colder by {:g} K (1σ)",
      kUmPerMm * scatter.reading_mm,
      plan.repeatability_mm > 0.0 ? " and what the scales leave" : "", 1e6 * kWavelength,
      kUmPerMm * ShopFloor{}.drift_mm, kUmPerMm * plan.station_mm, kTracedGrowth_K);
}

TracedErrors trace_errors(const TrueMachine& truth, const host::MachineFile& file,
                          const TracedPlan& traced, const TracerScatter& scatter,
                          std::size_t knots) {
  identify::MeasurementPlan plan = plan_of(file, traced, scatter.reading_mm);
  read_all(truth, scatter, plan);
  const identify::Equations equations(plan.problem, true);
  const identify::Solution solution = identify::solve(equations, false);
  if (!solution.converged)
    throw host::UserError(fmt::format("{}: the errors of the machine cannot be found [{}]",
                                      file.path, code(Reason::not_converged)));
  TracedErrors out;
  out.built = identify::tables_of_estimate(file, equations.unknowns(), solution.estimate.x, knots);
  out.functions = curves_of(file, equations, solution);
  out.values = values_of(equations, solution);
  for (const identify::SetUp& s : plan.problem.setups)
    out.readings += s.y.size();
  out.unknowns = static_cast<std::size_t>(equations.unknowns().size());
  out.chi2_over_dof = solution.chi2 / static_cast<double>(solution.dof);
  compare(truth, equations, solution, out);
  return out;
}

std::vector<std::string> refusal_of(const host::MachineFile& file, const TracedPlan& traced) {
  const identify::Refusal refusal =
      identify::check_problem(plan_of(file, traced, kTracer_mm).problem);
  if (refusal.ok()) return {};
  std::vector<std::string> said{code(refusal.reason)};
  said.insert(said.end(), refusal.names.begin(), refusal.names.end());
  return said;
}

}  // namespace volcomp::sim
