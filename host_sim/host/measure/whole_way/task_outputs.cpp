#include "host_sim/host/measure/whole_way/task_outputs.hpp"

#include <algorithm>

#include "host_sim/host/machine/xyz_axes.hpp"
#include "host_sim/host/measure/volume_csv.hpp"

namespace volcomp::host {
namespace {

using TaskFigureKind = FigureOfTask::Kind;

// A rigid motion has six parts only where the places do not lie on a line.
bool span_a_plane(const std::vector<Vec3>& way) {
  constexpr double kNarrow = 1e-3;  // of the length squared
  double longest = 0.0;
  for (const Vec3& p : way)
    longest = std::max(longest, (p - way.front()).squaredNorm());
  for (const Vec3& p : way) {
    for (const Vec3& q : way) {
      if ((p - way.front()).cross(q - way.front()).norm() > kNarrow * longest) return true;
    }
  }
  return false;
}

double largest_of(const TaskErrors& errors, const Vec3& from) {
  double largest = 0.0;
  for (const Vec3& e : errors)
    largest = std::max(largest, (e - from).norm());
  return largest;
}

double range_along(const TaskErrors& errors, const Vec3& direction) {
  const auto along = [&](const Vec3& e) { return direction.dot(e); };
  const auto [low, high] =
      std::minmax_element(errors.begin(), errors.end(),
                          [&](const Vec3& a, const Vec3& b) { return along(a) < along(b); });
  return along(*high) - along(*low);
}

Vec3 coordinates_of(const Pose& place, const MachineFile& machine) {
  Vec3 xyz = Vec3::Zero();
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const AxisFile& axis = machine.axes[a];
    if (axis.rotary || axis.letter < 'X' || axis.letter > 'Z') continue;
    xyz(axis.letter - 'X') = place[a];
  }
  return xyz;
}

}  // namespace

TaskOutputs::TaskOutputs(const MachineFile& machine, const Task& task, Travel travel)
    : task_(task) {
  travels_.fill(travel);
  if (task.places.size() < 2) return;
  figures_.push_back({TaskFigureKind::from_nominal, "from_nominal", "largest |E − E nominal|"});
  figures_.push_back({TaskFigureKind::largest, "largest", "largest |E|"});
  figures_.push_back(
      {TaskFigureKind::from_first, "from_first", "largest |E − E at the first place|"});
  const XyzAxes axes(machine);
  for (const Pose& place : task.places)
    way_.push_back(axes.in_base(coordinates_of(place, machine)));
  if (task.kind == TaskKind::line) {
    const Vec3 line = way_.back() - way_.front();
    if (line.norm() > 0.0) direction_ = line.normalized();
    if (line.norm() > 0.0)
      figures_.push_back({TaskFigureKind::along, "range_along", "range of E along the line"});
  } else if (!machine.chain.has_rotary() && span_a_plane(way_)) {
    figures_.push_back({TaskFigureKind::rigid, "rigid", "largest |E| after the best rigid motion"});
  }
}

TaskErrors TaskOutputs::errors(const VolumetricModel& model) const {
  const bool rotary = model.chain.has_rotary();
  TaskErrors errors;
  errors.reserve(task_.places.size());
  for (const Pose& q : task_.places)
    errors.push_back(rotary ? model.second_order(q, travels_, Beyond::stand_at_end)
                            : model.first_order(q, travels_, Beyond::stand_at_end));
  return errors;
}

double TaskOutputs::figure(const FigureOfTask& figure, const TaskErrors& errors,
                           const TaskErrors& nominal) const {
  switch (figure.kind) {
    case TaskFigureKind::from_nominal: {
      double largest = 0.0;
      for (std::size_t i = 0; i < errors.size(); ++i)
        largest = std::max(largest, (errors[i] - nominal[i]).norm());
      return largest;
    }
    case TaskFigureKind::largest:
      return largest_of(errors, Vec3::Zero());
    case TaskFigureKind::from_first:
      return largest_of(errors, errors.front());
    case TaskFigureKind::rigid:
      return largest_of(aligned_errors(way_, errors), Vec3::Zero());
    case TaskFigureKind::along:
      break;
  }
  return range_along(errors, direction_);
}

}  // namespace volcomp::host
