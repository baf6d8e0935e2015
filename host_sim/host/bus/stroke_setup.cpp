#include "host_sim/host/bus/stroke_setup.hpp"

#include <array>

#include <fmt/format.h>

#include "firmware/node/node_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

std::uint8_t number_of_axis(const BusSettings& b, char letter) {
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    if (b.axes[i].letter == letter) return static_cast<std::uint8_t>(i + 1);
  }
  throw UserError(fmt::format("a grinder of helical gears needs an axis {} on the bus", letter));
}

template <class Values>
void plan_reals(SetupPlan& plan, const node::object_lines::Handle<double>& object,
                const Values& values, const char* name, const char* unit = "") {
  for (std::size_t i = 0; i < values.size(); ++i)
    plan_value(plan, object[i], values[i], name, unit);
}

void plan_stroke_grid(SetupPlan& plan, const BusSettings& b, const WatchedStrokes& w) {
  constexpr std::array<char, 3> kAxes{'X', 'Z', 'C'};
  for (std::size_t i = 0; i < kAxes.size(); ++i)
    plan_value(plan, node::object::stroke::axis[i], number_of_axis(b, kAxes[i]),
               fmt::format("number of axis {} of the grinder", kAxes[i]));
  plan_value(plan, node::object::stroke::slots, w.slots, "slots of the gear");
  plan_value(plan, node::object::stroke::nodes, static_cast<std::uint16_t>(w.monitor.nodes),
             "nodes along the stroke");
  plan_value(plan, node::object::stroke::pitch_nm, w.monitor.node_pitch_nm, "distance of the nodes",
             "nm");
  plan_value(plan, node::object::stroke::first_node_nm, w.monitor.z0_nm, "first node", "nm");
  plan_value(plan, node::object::stroke::rate, w.offsets.rate,
             "fastest change of the learned offset", "2^-32 turn/cycle");
  plan_value(plan, node::object::stroke::stale_cycles,
             static_cast<std::uint16_t>(w.offsets.stale_ticks),
             "missing process data until the learned offset is dropped", "cycles");
}

void plan_learning(SetupPlan& plan, const WatchedStrokes& w) {
  plan_reals(plan, node::object::stroke::rules,
             std::array<double, 6>{w.along.weight, w.along.dead_sigma, w.along.most_step,
                                   w.along.most_offset, w.along.most_slope, w.around.most_slope},
             "rule of learning");
  plan_value(plan, node::object::stroke::least_samples[0], w.along.least_samples,
             "least samples of a node");
  plan_value(plan, node::object::stroke::least_samples[1], w.around.least_samples,
             "least samples of a slot");
  plan_value(plan, node::object::stroke::target, static_cast<std::uint8_t>(w.target),
             "learn from (0 synchronisation, 3 C alone)");
  plan_value(plan, node::object::stroke::force, w.target == LearningTarget::synchronisation ? 0 : 1,
             "learn even what breaks the helix");
}

}  // namespace

SetupPlan stroke_plan(const BusSettings& settings, const WatchedStrokes& strokes) {
  SetupPlan plan;
  plan_value(plan, node::object::stroke::command,
             static_cast<std::uint8_t>(node::StrokeCommand::off), "strokes off");
  plan_stroke_grid(plan, settings, strokes);
  plan_reals(plan, node::object::stroke::gear,
             std::array<double, 3>{strokes.monitor.turn_per_mm, strokes.monitor.flank_per_rad,
                                   strokes.monitor.flank_per_x},
             "helical gear");
  plan_reals(plan, node::object::stroke::wavelength_mm, strokes.monitor.order_wavelength_mm,
             "wavelength of a line", "mm");
  plan_reals(plan, node::object::stroke::frequency_hz, strokes.monitor.time_line_hz,
             "frequency of a line", "Hz");
  plan_learning(plan, strokes);
  plan_value(plan, node::object::stroke::command,
             static_cast<std::uint8_t>(node::StrokeCommand::on), "strokes on");
  return plan;
}

}  // namespace volcomp::host
