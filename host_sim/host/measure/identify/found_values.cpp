#include "host_sim/host/measure/identify/found_values.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/measure/identify/volume.hpp"

namespace volcomp::host::identify {
namespace {

// The van der Corput sequence: evenly over 0…1 for any number of terms.
double evenly(std::size_t n, std::size_t base) {
  double place = 0.0;
  double digit = 1.0;
  for (; n > 0; n /= base) {
    digit /= static_cast<double>(base);
    place += digit * static_cast<double>(n % base);
  }
  return place;
}

// Slope of a straightness over the travel, relative value; none where it is not an unknown.
std::optional<VectorXd> slope_row(const Unknowns& unknowns, const MachineFile& machine, char axis,
                                  std::size_t channel) {
  for (const Quantity& quantity : unknowns.quantities()) {
    const AxisFile& file = machine.axes[quantity.axis];
    if (quantity.kind != QuantityKind::function || quantity.channel != channel ||
        file.letter != axis || file.rotary)
      continue;
    const Travel& travel = unknowns.problem().machine.travel.at(quantity.axis);
    const FunctionBasis basis(travel.lo, travel.hi, travel.periodic, 1);
    const std::vector<double> places = basis.samples();
    const std::vector<double> weights = basis.slope_weights();
    const double side = branch_sign(machine.chain.axis(quantity.axis).branch);
    VectorXd row = VectorXd::Zero(unknowns.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      row += side * weights[k] * unknowns.value_row(quantity, places[k]);
    return row;
  }
  return std::nullopt;
}

}  // namespace

double FoundFunction::largest_u() const {
  double largest = 0.0;
  for (const Measured& v : value)
    largest = std::max(largest, v.u);
  return largest;
}

Measured Values::of(const VectorXd& row) const {
  return {x_ != nullptr ? row.dot(*x_) : 0.0, triangle_.uncertainty(row)};
}

std::vector<FoundFunction> Values::functions(const MachineFile& machine) const {
  std::vector<FoundFunction> out;
  for (const Quantity& quantity : unknowns_.quantities()) {
    if (quantity.kind != QuantityKind::function) continue;
    FoundFunction f{quantity, machine.axes[quantity.axis].all_targets(), {}};
    for (const double at : f.at)
      f.value.push_back(of(unknowns_.value_row(quantity, at)));
    out.push_back(std::move(f));
  }
  return out;
}

std::vector<FoundValue> Values::singles() const {
  std::vector<FoundValue> out;
  for (const Quantity& quantity : unknowns_.quantities())
    if (quantity.kind != QuantityKind::function)
      out.push_back({quantity, of(unknowns_.value_row(quantity, 0.0))});
  return out;
}

// In the datum of Y: SquareDatum, row by row.
std::optional<FoundSquareness> Values::squareness(const MachineFile& machine) const {
  const auto slope = [&](char axis, std::size_t channel) {
    return slope_row(unknowns_, machine, axis, channel);
  };
  const auto X_y = slope('X', 1);
  const auto X_z = slope('X', 2);
  const auto Y_x = slope('Y', 0);
  const auto Y_z = slope('Y', 2);
  const auto Z_x = slope('Z', 0);
  const auto Z_y = slope('Z', 1);
  if (!X_y || !X_z || !Y_x || !Y_z || !Z_x || !Z_y) return std::nullopt;
  return FoundSquareness{of(*X_y + *Y_x), of(*Z_x + *X_z), of(-*Z_y - *Y_z)};
}

std::vector<Pose> places_of(const Machine& machine, std::size_t count) {
  constexpr std::array<std::size_t, kMaxAxes> kPrimes{2, 3, 5, 7, 11, 13, 17, 19};
  std::vector<Pose> places(count);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t a = 0; a < machine.chain.axis_count(); ++a) {
      const Travel& travel = machine.travel.at(a);
      places[n].at(a) = travel.lo + (travel.hi - travel.lo) * evenly(n + 1, kPrimes.at(a));
    }
  return places;
}

FoundVolume volume_of(const Equations& equations, const Triangle& triangle) {
  constexpr std::size_t kPlaces = 1000;
  const Machine& machine = equations.problem().machine;
  VolumeUncertainty u = volume_uncertainty(equations, triangle, places_of(machine, kPlaces),
                                           machine.chain.tool_point());
  FoundVolume out;
  out.rms = u.rms_rigid();
  std::sort(u.rigid.begin(), u.rigid.end());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(u.rigid.size())));
  out.p95 = u.rigid[rank - 1];
  out.max = u.rigid.back();
  return out;
}

}  // namespace volcomp::host::identify
