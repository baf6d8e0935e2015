#include "host_sim/host/tables/evaluation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/pose_offset.hpp"
#include "comp/metrology/tables/quantise.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using Units = std::array<std::int64_t, kMaxAxes>;

constexpr double kRadPerOutput = 256.0 / kUnitsPerRad;  // 2^-32 turn

bool turns(const MachineChain& chain, std::size_t a) {
  return chain.axis(a).kind == JointKind::rotary;
}

double units_of(const MachineChain& chain, std::size_t a) {
  return turns(chain, a) ? kUnitsPerRad : kNmPerMm;
}

// Nothing limited and nothing delayed: the output of a tick is the offset of this very tick.
OrientingCompensator::Settings unlimited() {
  OrientingCompensator::Settings settings;
  settings.source = PositionSource::actual;
  settings.ramp_ticks = 1;
  for (AxisLimits& axis : settings.axis)
    axis = {{4'194'303, 1'000'000'000, 1'000'000'000, 0}, 0, 0};
  return settings;
}

bool has_room(const MachineTables& tables, std::size_t axes) {
  if (axes > OrientingCompensator::kAxes) return false;
  return std::all_of(tables.axis.begin(), tables.axis.begin() + static_cast<std::ptrdiff_t>(axes),
                     [](const AxisTable& t) { return t.knots <= kDefaultKnots; });
}

std::unique_ptr<OrientingCompensator> make_tick(const MachineTables& tables,
                                                const MachineChain& chain,
                                                const std::string& name) {
  if (!has_room(tables, chain.axis_count())) return nullptr;
  auto tick =
      std::make_unique<OrientingCompensator>(OrientingMachine{make_runtime_chain(tables.machine)});
  require(tick->configure(unlimited()), name);
  require(tick->stage(tables, chain.tool_point(), 0), name);
  require(tick->activate(), name);
  return tick;
}

// The larger of the two, for each kind of axis.
void widen(const MachineChain& chain, const Pose& a, const Pose& b, OffsetDistance& distance) {
  for (std::size_t axis = 0; axis < chain.axis_count(); ++axis) {
    const double off = std::abs(a[axis] - b[axis]);
    if (turns(chain, axis)) {
      distance.nrad = std::max(distance.nrad, 1e9 * off);
    } else {
      distance.nm = std::max(distance.nm, kNmPerMm * off);
    }
  }
}

}  // namespace

TableEvaluator::TableEvaluator(const MachineTables& tables, const std::string& name, Travel travel)
    : name_(name), travel_(travel), model_(table_model(tables, name)) {
  require_foldable(tables, name);
  travels_.fill(travel);
  tick_ = make_tick(tables, chain(), name);
}

std::optional<bool> TableEvaluator::within_1nm() const {
  if (tick_ == nullptr) return std::nullopt;
  return tick_->fold_report().within_1nm;
}

std::vector<std::size_t> TableEvaluator::offset_axes() const {
  const MachineDescription& d = chain().description();
  std::vector<std::size_t> axes(d.correcting.begin(), d.correcting.begin() + d.correcting_count);
  axes.insert(axes.end(), d.orienting.begin(), d.orienting.begin() + d.orienting_count);
  std::sort(axes.begin(), axes.end());
  return axes;
}

std::vector<Pose> TableEvaluator::grid(std::size_t count) const {
  const std::size_t axes = chain().axis_count();
  std::size_t total = 1;
  for (std::size_t a = 0; a < axes; ++a) {
    total *= count;
    if (total > kMostGridPoints)
      throw UserError(fmt::format("a grid of {} points for each of {} axes has more than {} points",
                                  count, axes, kMostGridPoints));
  }
  std::vector<Pose> points;
  points.reserve(total);
  for (std::size_t n = 0; n < total; ++n) {
    Pose q{};
    std::size_t rest = n;
    for (std::size_t a = axes; a > 0; --a) {
      const ErrorTable& table = *model_.tables[a - 1];
      const std::size_t steps = is_full_turn(table, chain().axis(a - 1)) ? count : count - 1;
      const double part = static_cast<double>(rest % count) / static_cast<double>(steps);
      q[a - 1] = table.q0 + part * (table.last() - table.q0);
      rest /= count;
    }
    points.push_back(q);
  }
  return points;
}

// Seen from `held`, where every axis is in its table: as in the tick, the lever arms are those of
// there, too.
void TableEvaluator::set_exact(const Pose& held, EvaluatedPoint& point) const {
  const VolumetricModel& m = model_.model;
  const VolumetricError e = exact_error(
      m.chain, held, m.errors(held, travels_), squareness_translation(m.chain, held, m.directions),
      RotationModel::rxryrz, ideal_points(m.chain, held, m.tool_point));
  // What the axes can take away is the error as the work sees it, turned to base.
  point.position = m.chain.ideal(m.chain.work(), held).R * e.position_work;
  point.orientation = e.orientation_base;
  PoseOffset offset;
  point.authority =
      pose_offset(m.chain, held, m.tool_point, point.position, point.orientation, offset).ok();
  if (point.authority) point.exact = offset.offset;
}

// The tick takes positions to second order where an axis turns, orientations to first order.
void TableEvaluator::set_model(const Pose& held, EvaluatedPoint& point) const {
  const VolumetricModel& m = model_.model;
  const Vec3 position = m.chain.has_rotary() ? m.second_order(held, travels_, Beyond::stand_at_end)
                                             : m.first_order(held, travels_, Beyond::stand_at_end);
  const Vec3 orientation = first_order_error(m.chain, held, m.errors(held, travels_),
                                             squareness_translation(m.chain, held, m.directions),
                                             ideal_points(m.chain, held, m.tool_point))
                               .orientation_base;
  PoseOffset offset;
  if (pose_offset(m.chain, held, m.tool_point, position, orientation, offset).ok())
    point.model = offset.offset;
}

// After a fresh start the direction is unknown; one unit of travel determines it.
Pose TableEvaluator::tick_at(const Units& units) {
  require(tick_->start_from({}), name_);
  OrientingCompensator::Input in;
  OrientingCompensator::Output out;
  const auto tick = [&](std::int64_t beside) {
    for (std::size_t a = 0; a < chain().axis_count(); ++a)
      in.axis[a] = {units[a] + beside, true, true};
    tick_->tick(in, out);
  };
  // The direction is that of whole nm or 2^-32 turn.
  constexpr std::int64_t kStep = 1 << 8;
  if (travel_ == Travel::forward) tick(-kStep);
  if (travel_ == Travel::backward) tick(kStep);
  tick(0);
  Pose offset{};
  for (std::size_t a = 0; a < chain().axis_count(); ++a)
    offset[a] =
        static_cast<double>(out.offset[a]) * (turns(chain(), a) ? kRadPerOutput : 1.0 / kNmPerMm);
  return offset;
}

EvaluatedPoint TableEvaluator::evaluate_at(const Pose& position) {
  EvaluatedPoint point;
  Units units{};
  for (std::size_t a = 0; a < chain().axis_count(); ++a) {
    units[a] = turns(chain(), a) ? std::llround(position[a] * kUnitsPerRad) : to_nm(position[a]);
    point.at[a] = static_cast<double>(units[a]) / units_of(chain(), a);
  }
  const Pose held = model_.model.held(point.at);
  for (std::size_t a = 0; a < chain().axis_count(); ++a)
    if (std::abs(held[a] - point.at[a]) * units_of(chain(), a) > 0.5) point.beyond |= 1U << a;
  set_exact(held, point);
  if (!point.authority) return point;
  set_model(held, point);
  if (tick_ != nullptr) point.tick = tick_at(units);
  return point;
}

Evaluation TableEvaluator::evaluate(const std::vector<Pose>& positions) {
  Evaluation evaluation;
  evaluation.points.reserve(positions.size());
  for (const Pose& position : positions) {
    const EvaluatedPoint point = evaluate_at(position);
    widen(chain(), point.model, point.exact, evaluation.model_from_exact);
    if (point.tick) widen(chain(), *point.tick, point.model, evaluation.tick_from_model);
    evaluation.points.push_back(point);
  }
  return evaluation;
}

}  // namespace volcomp::host
