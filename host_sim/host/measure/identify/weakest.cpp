#include "host_sim/host/measure/identify/weakest.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host::identify {
namespace {

constexpr const char* kAxes = "XYZ";

// A linear function of the unknowns: u times a vector of length 1, in which correlations are
// scalar products.
struct Direction {
  Quantity quantity;
  double at = 0.0;
  double u = 0.0;
  VectorXd unit;
};

Direction direction_of(const Triangle& triangle, const Quantity& quantity, double at,
                       const VectorXd& row) {
  Direction d{quantity, at, 0.0, triangle.reduced(row)};
  d.u = d.unit.norm();
  if (d.u > 0.0) d.unit /= d.u;
  return d;
}

// Every value that is reported: functions at all targets.
std::vector<Direction> directions_of(const Unknowns& unknowns, const Triangle& triangle,
                                     const MachineFile& machine) {
  std::vector<Direction> all;
  for (const Quantity& quantity : unknowns.quantities()) {
    const std::vector<double> places = quantity.kind == QuantityKind::function
                                           ? machine.axes[quantity.axis].all_targets()
                                           : std::vector<double>{0.0};
    for (const double at : places) {
      Direction d = direction_of(triangle, quantity, at, unknowns.value_row(quantity, at));
      if (d.u > 0.0) all.push_back(std::move(d));
    }
  }
  return all;
}

// Of each quantity where it is known least.
std::vector<const Direction*> worst_places(const std::vector<Direction>& all) {
  std::vector<const Direction*> worst;
  for (const Direction& d : all) {
    if (worst.empty() || worst.back()->quantity.name != d.quantity.name) worst.push_back(&d);
    if (worst.back()->u < d.u) worst.back() = &d;
  }
  return worst;
}

double median_u(const std::vector<const Direction*>& worst, bool angular) {
  std::vector<double> u;
  for (const Direction* d : worst)
    if (d->quantity.angular() == angular) u.push_back(d->u);
  return u.empty() ? 0.0 : median(std::move(u));
}

std::string place_name(const MachineFile& machine, const Direction& d) {
  if (d.quantity.kind != QuantityKind::function) return d.quantity.name;
  const AxisFile& axis = machine.axes[d.quantity.axis];
  return fmt::format("{} at {} {:.4g} {}", d.quantity.name, axis.letter,
                     axis.rotary ? kDegPerRad * d.at : d.at, axis.rotary ? "deg" : "mm");
}

void find_partner(const std::vector<Direction>& all, const MachineFile& machine,
                  const std::vector<std::string>& names, const Triangle& triangle,
                  const Direction& of, WeakValue& weak) {
  const auto take = [&](double correlation, const auto& name) {
    if (std::abs(correlation) <= std::abs(weak.correlation)) return;
    weak.correlation = correlation;
    weak.with = name();
  };
  for (const Direction& d : all)
    if (d.quantity.name != of.quantity.name)
      take(of.unit.dot(d.unit), [&] { return place_name(machine, d); });
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) continue;
    const VectorXd unit =
        triangle.reduced(VectorXd::Unit(static_cast<Index>(names.size()), static_cast<Index>(i)));
    const double u = unit.norm();
    if (u > 0.0) take(of.unit.dot(unit) / u, [&] { return names[i]; });
  }
}

std::vector<std::string> local_names(const Problem& problem, const SetUp& s) {
  switch (s.kind) {
    case ObservationKind::tracer:
      return {"station X", "station Y", "station Z", "dead length"};
    case ObservationKind::bar:
      return {"socket, first way in the plane", "socket, second way in the plane", "length"};
    case ObservationKind::diagonal:
      return {"zero of its readings"};
    case ObservationKind::step:
      return {"first tilt of the mirror", "second tilt of the mirror", "zero of its readings"};
    case ObservationKind::centre:
    case ObservationKind::touch:
      return {"turn about X", "turn about Y", "turn about Z", "place X", "place Y", "place Z"};
    case ObservationKind::rtest:
      return {"sphere X", "sphere Y", "sphere Z"};
    case ObservationKind::runs:
      break;
  }
  std::vector<std::string> names;
  for (const std::size_t c : s.channels)
    names.push_back(fmt::format("zero of {}", kChannelNames.at(c)));
  for (const std::size_t k : sloped_channels(problem, s))
    names.push_back(fmt::format("slope of {}", kChannelNames.at(s.channels[k])));
  return names;
}

}  // namespace

std::vector<std::string> unknown_names(const Unknowns& unknowns) {
  const Problem& problem = unknowns.problem();
  std::vector<std::string> names(static_cast<std::size_t>(unknowns.size()));
  const auto put = [&](std::optional<Index> at, std::size_t k, const std::string& name) {
    if (at) names[static_cast<std::size_t>(*at) + k] = name;
  };
  for (std::size_t s = 0; s < problem.styli.size(); ++s) {
    for (std::size_t k = 0; k < 3; ++k)
      put(unknowns.stylus(s), k, fmt::format("tip {} {}", problem.styli[s].name, kAxes[k]));
    put(unknowns.stylus_radius(s), 0, fmt::format("radius of tip {}", problem.styli[s].name));
  }
  for (std::size_t a = 0; a < problem.artefacts.size(); ++a) {
    const Artefact& artefact = problem.artefacts[a];
    for (std::size_t k = 0; k < 3 * artefact.spheres.size(); ++k)
      put(unknowns.spheres(a), k,
          fmt::format("{}: sphere {} {}", artefact.name, k / 3, kAxes[k % 3]));
    put(unknowns.artefact_scale(a), 0, fmt::format("{}: scale", artefact.name));
  }
  for (std::size_t k = 0; k < problem.setups.size(); ++k) {
    const SetUp& s = problem.setups[k];
    const std::vector<std::string> local = local_names(problem, s);
    for (std::size_t i = 0; i < local.size(); ++i)
      put(unknowns.local(k), i, fmt::format("{}: {}", s.name, local[i]));
    put(unknowns.setup_scale(k), 0, fmt::format("{}: scale", s.name));
    for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a)
      put(unknowns.setup_growth(k, a), 0,
          fmt::format("{}: growth of {}", s.name, problem.machine.name_of(a)));
  }
  return names;
}

std::vector<WeakValue> weakest_values(const Equations& equations, const Triangle& triangle,
                                      const MachineFile& machine, std::size_t count) {
  const Unknowns& unknowns = equations.unknowns();
  const std::vector<Direction> all = directions_of(unknowns, triangle, machine);
  std::vector<const Direction*> worst = worst_places(all);
  const std::array<double, 2> usual{median_u(worst, false), median_u(worst, true)};
  const auto times = [&](const Direction& d) {
    return d.u / usual.at(d.quantity.angular() ? 1 : 0);
  };
  std::stable_sort(worst.begin(), worst.end(),
                   [&](const Direction* a, const Direction* b) { return times(*a) > times(*b); });
  worst.resize(std::min(worst.size(), count));
  const std::vector<std::string> names = unknown_names(unknowns);
  std::vector<WeakValue> out;
  for (const Direction* d : worst) {
    out.push_back({d->quantity, d->at, d->u, times(*d), {}, 0.0});
    find_partner(all, machine, names, triangle, *d, out.back());
  }
  return out;
}

}  // namespace volcomp::host::identify
