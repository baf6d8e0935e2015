#include "host_sim/experiments/any_machine/verification.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"

namespace volcomp::any_machine {
namespace {

host::VolumeFigures figures_of(const MachineChain& chain,
                               const std::vector<PlaceReading>& readings) {
  std::vector<host::VolumePoint> points;
  points.reserve(readings.size());
  for (const PlaceReading& r : readings)
    points.push_back({ideal_points(chain, r.pose, chain.tool_point()).work, r.deviation_mm});
  return points.empty() ? host::VolumeFigures{} : host::aligned_volume_figures(std::move(points));
}

template <class Visit>
void for_each_reading(const MachineState& state, const Visit& visit) {
  for (const auto* readings : {&state.place, &state.sphere}) {
    for (const PlaceReading& r : *readings)
      visit(r);
  }
}

}  // namespace

double MachineState::lines_max_um() const {
  double worst = 0.0;
  for (const sim::MeasuredDiagonal& d : line)
    worst = std::max(worst, d.max_abs_um);
  return worst;
}

host::VolumeFigures MachineState::sphere_um() const {
  host::VolumeFigures f;
  double squares = 0.0;
  for (const PlaceReading& r : sphere) {
    const double um = kUmPerMm * r.deviation_mm.norm();
    f.max_um = std::max(f.max_um, um);
    squares += um * um;
  }
  if (!sphere.empty()) f.rms_um = std::sqrt(squares / static_cast<double>(sphere.size()));
  return f;
}

double MachineState::tilt_max_rad() const {
  double worst = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { worst = std::max(worst, r.tilt_rad); });
  return worst;
}

double MachineState::tilt_rms_rad() const {
  double squares = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { squares += r.tilt_rad * r.tilt_rad; });
  const std::size_t count = place.size() + sphere.size();
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

double MachineState::steerable_max_rad() const {
  double worst = 0.0;
  for_each_reading(*this, [&](const PlaceReading& r) { worst = std::max(worst, r.steerable_rad); });
  return worst;
}

Verification plan_verification(const host::MachineFile& file, std::size_t places,
                               std::uint64_t seed) {
  return {diagonals_of(file), random_poses(file, places, seed), plan_sphere_test(file)};
}

MachineState verify_machine(const host::MachineFile& file, const sim::TrueMachine& truth,
                            const Verification& plan, const sim::CellFactory& make_cell,
                            const std::vector<std::uint8_t>& image) {
  const auto cell = make_cell(truth, file.correction, image);
  Pose start{};
  for (std::size_t a = 0; a < file.axes.size(); ++a)
    start[a] = file.axes[a].reference;
  cell->place(start);
  MachineState state;
  for (const sim::MeasuredLine& line : plan.lines)
    state.line.push_back(measure_line(*cell, file.chain, line));
  state.sphere = measure_sphere(*cell, file.chain, plan.sphere);
  state.place = measure_places(*cell, file.chain, plan.poses);
  state.volume = figures_of(file.chain, state.place);
  return state;
}

}  // namespace volcomp::any_machine
