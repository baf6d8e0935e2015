#include "host_sim/host/bus/stroke_setup.hpp"

#include <array>

#include <fmt/format.h>

#include "firmware/node/node_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

namespace stroke = node::object::stroke;

std::uint8_t number_of_axis(const BusSettings& b, char letter) {
  for (std::size_t i = 0; i < b.axes.size(); ++i) {
    if (b.axes[i].letter == letter) return static_cast<std::uint8_t>(i + 1);
  }
  throw UserError(fmt::format("a grinder of helical gears needs an axis {} on the bus", letter));
}

void plan_stroke_grid(SetupPlan& plan, const BusSettings& b, const WatchedStrokes& w) {
  constexpr std::array<char, 3> kAxes{'X', 'Z', 'C'};
  for (std::size_t i = 0; i < kAxes.size(); ++i)
    plan_value(plan, stroke::axis[i], number_of_axis(b, kAxes[i]));
  plan_value(plan, stroke::slots, w.slots);
  plan_value(plan, stroke::nodes, static_cast<std::uint16_t>(w.monitor.nodes));
  plan_value(plan, stroke::pitch_nm, w.monitor.node_pitch_nm);
  plan_value(plan, stroke::first_node_nm, w.monitor.z0_nm);
  plan_value(plan, stroke::rate, w.offsets.rate, "2^-32 turn");
  plan_value(plan, stroke::stale_cycles, static_cast<std::uint16_t>(w.offsets.stale_ticks));
}

void plan_learning(SetupPlan& plan, const WatchedStrokes& w) {
  plan_values(plan, stroke::rules,
              std::array{w.along.weight, w.along.dead_sigma, w.along.most_step, w.along.most_offset,
                         w.along.most_slope, w.around.most_slope});
  plan_values(plan, stroke::least_samples,
              std::array{w.along.least_samples, w.around.least_samples});
  plan_value(plan, stroke::target, static_cast<std::uint8_t>(w.target));
  plan_value(plan, stroke::force, w.target == LearningTarget::synchronisation ? 0 : 1);
}

}  // namespace

SetupPlan stroke_plan(const BusSettings& settings, const WatchedStrokes& strokes) {
  const auto& monitor = strokes.monitor;
  SetupPlan plan;
  plan_value(plan, stroke::command, static_cast<std::uint8_t>(node::StrokeCommand::off));
  plan_stroke_grid(plan, settings, strokes);
  plan_values(plan, stroke::gear,
              std::array{monitor.turn_per_mm, monitor.flank_per_rad, monitor.flank_per_x});
  plan_values(plan, stroke::wavelength_mm, monitor.order_wavelength_mm);
  plan_values(plan, stroke::frequency_hz, monitor.time_line_hz);
  plan_learning(plan, strokes);
  plan_value(plan, stroke::command, static_cast<std::uint8_t>(node::StrokeCommand::on));
  return plan;
}

}  // namespace volcomp::host
