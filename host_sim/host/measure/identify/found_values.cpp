#include "host_sim/host/measure/identify/found_values.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/measure/identify/volume.hpp"

namespace volcomp::host::identify {
namespace {

// Over which the best rigid motion is taken.
constexpr std::size_t kRigidPlaces = 1000;

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

std::vector<double> spread(const Travel& travel, std::size_t count) {
  std::vector<double> places;
  for (std::size_t k = 0; k < count; ++k)
    places.push_back(travel.lo + (travel.hi - travel.lo) * static_cast<double>(k) /
                                     static_cast<double>(count - 1));
  return places;
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

Pose middle_of(const Problem& problem) {
  Pose q{};
  for (std::size_t a = 0; a < problem.machine.chain.axis_count(); ++a) {
    const Travel& travel = problem.machine.travel.at(a);
    q.at(a) = problem.is_slide(a) ? 0.5 * (travel.lo + travel.hi) : travel.reference;
  }
  return q;
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
  const Machine& machine = equations.problem().machine;
  const std::vector<Pose> places = places_of(machine, kRigidPlaces);
  const Vec3 tool = machine.chain.tool_point();
  const DrawnVolume drawn = draw_volume(equations, triangle, places, tool);
  return {volume_uncertainty(equations, triangle, places, tool).rms_rigid(), drawn.p95, drawn.max};
}

std::vector<VolumeSection> volume_sections(const Equations& equations, const Triangle& triangle) {
  constexpr std::size_t kSteps = 13;
  const Problem& problem = equations.problem();
  const Machine& machine = problem.machine;
  std::vector<VolumeSection> sections;
  std::vector<Pose> places;
  // In the order of their letters: Z is drawn upwards.
  std::vector<std::size_t> slides;
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a)
    if (problem.is_slide(a)) slides.push_back(a);
  std::sort(slides.begin(), slides.end(), [&](std::size_t a, std::size_t b) {
    return machine.chain.axis(a).letter < machine.chain.axis(b).letter;
  });
  for (std::size_t i = 0; i < slides.size(); ++i)
    for (std::size_t k = i + 1; k < slides.size(); ++k) {
      const std::size_t right = slides[i];
      const std::size_t up = slides[k];
      sections.push_back({right,
                          up,
                          spread(machine.travel.at(right), kSteps),
                          spread(machine.travel.at(up), kSteps),
                          {}});
      for (const double y : sections.back().row)
        for (const double x : sections.back().column) {
          places.push_back(middle_of(problem));
          places.back().at(right) = x;
          places.back().at(up) = y;
        }
    }
  if (sections.empty()) return sections;
  const std::vector<double> u = rigid_uncertainty_at(
      equations, triangle, places_of(machine, kRigidPlaces), places, machine.chain.tool_point());
  auto next = u.begin();
  for (VolumeSection& section : sections)
    for (std::size_t r = 0; r < section.row.size(); ++r, next += kSteps)
      section.u.emplace_back(next, next + kSteps);
  return sections;
}

}  // namespace volcomp::host::identify
