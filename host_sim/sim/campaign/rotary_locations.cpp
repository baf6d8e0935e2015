#include "host_sim/sim/campaign/rotary_locations.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/planned_places.hpp"
#include "host_sim/host/measure/identify/rank.hpp"
#include "host_sim/sim/campaign/simulated_readings.hpp"
#include "host_sim/sim/campaign/tracer_stations.hpp"

namespace volcomp::sim {
namespace {

namespace identify = host::identify;

constexpr double kRepeatability_mm = 0.7e-3;  // of a machine of this class, 1 sigma, from memory
constexpr std::size_t kPlaces = 60;           // a station

// Errors that the tables hold, as an instrument finds them; the directions of the axes as errors of
// their carriages.
ErrorSet errors_known(const VolumetricModel& known, const Pose& q, const identify::Directions& d) {
  Travels travels{};
  for (std::size_t a = 0; a < travels.size(); ++a)
    travels.at(a) = d.at(a) > 0.0   ? Travel::forward
                    : d.at(a) < 0.0 ? Travel::backward
                                    : Travel::unknown;
  ErrorSet errors = known.errors(q, travels);
  const identify::ChainGeometry g = identify::ideal_geometry(known.chain, q);
  for (std::size_t a = 0; a < known.chain.axis_count(); ++a)
    errors.at(a).head<3>() +=
        g.side.at(a) * (g.joint.at(a).R.transpose() * (known.directions.at(a) * q.at(a)));
  return errors;
}

identify::MeasurementPlan plan_of(const host::MachineFile& file, const VolumetricModel& known) {
  identify::MeasurementPlan plan;
  plan.path = file.path;
  plan.machine = file;
  plan.problem.machine = machine_of(file);
  identify::ask_for_locations(plan.problem);
  for (const Vec3& station : stations_about(plan.problem.machine)) {
    identify::SetUp s;
    s.name = fmt::format("station {}", plan.problem.setups.size() + 1);
    s.kind = identify::ObservationKind::tracer;
    s.station = station;
    s.scale = kWavelength;
    identify::PlaceChoice choice;
    choice.count = kPlaces;
    identify::add_planned_places(plan, choice, s);
    s.sigma.assign(s.q.size(), std::hypot(kTracer_mm, kRepeatability_mm));
    for (std::size_t i = 0; i < s.q.size(); ++i)
      s.known.push_back(errors_known(known, s.q[i], s.d[i]));
    plan.problem.setups.push_back(std::move(s));
  }
  return plan;
}

void leave_out(const std::string& name, identify::Problem& problem) {
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    for (auto* where : {&problem.model.location.at(a), &problem.model.constant.at(a)}) {
      const char* const digit = where == &problem.model.location.at(a) ? "0" : "1";
      const auto is_it = [&](std::size_t c) {
        return identify::kChannelNames.at(c) + (digit + problem.machine.name_of(a)) == name;
      };
      where->erase(std::remove_if(where->begin(), where->end(), is_it), where->end());
    }
  }
}

// What is seen only together cannot be told apart: one of it is held where the machine file has it.
std::vector<std::string> leave_out_unseen(identify::Problem& problem) {
  std::vector<std::string> left_out;
  for (;;) {
    const identify::PlanRank rank = identify::rank_of(problem);
    if (rank.together.empty()) return left_out;
    left_out.push_back(rank.together.front().back());
    leave_out(left_out.back(), problem);
  }
}

RotaryLocations locations_of(const identify::Equations& equations,
                             const identify::Solution& solution) {
  RotaryLocations out;
  const identify::Values values(equations, solution.triangle, &solution.estimate.x);
  for (const identify::FoundValue& v : values.singles()) {
    AverageLine& place = out.place.at(v.quantity.axis);
    ErrorMotion& side =
        v.quantity.kind == identify::QuantityKind::location ? place.fixed : place.moving;
    side(static_cast<Eigen::Index>(v.quantity.channel)) = v.value.value;
    out.found.push_back({v.quantity.name, v.quantity.angular(), v.value.value, v.value.u});
  }
  return out;
}

}  // namespace

RotaryLocations locate_rotary_axes(const TrueMachine& truth, const host::MachineFile& file,
                                   const VolumetricModel& known, const LocationSurvey& survey) {
  if (std::none_of(file.axes.begin(), file.axes.end(),
                   [](const host::AxisFile& axis) { return axis.rotary; }))
    return {};
  identify::MeasurementPlan plan = plan_of(file, known);
  ShopFloor floor;
  floor.perfect = survey.perfect;
  floor.seed = survey.seed;
  const PlanTruth shop = draw_plan_truth(plan.problem, truth, floor);
  const std::vector<std::string> assumed = leave_out_unseen(plan.problem);
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k)
    read_instrument(plan, shop, k, plan.problem.setups[k]);
  const identify::Equations equations(plan.problem, true);
  const identify::Solution solution = identify::solve(equations, false);
  if (!solution.converged)
    throw host::UserError(fmt::format("{}: the places of the rotary axes cannot be found [{}]",
                                      file.path, code(Reason::not_converged)));
  RotaryLocations out = locations_of(equations, solution);
  out.assumed = assumed;
  out.misfit = std::sqrt(solution.chi2 / static_cast<double>(solution.dof));
  return out;
}

}  // namespace volcomp::sim
