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
void plan_reals(SetupPlan& plan, std::uint16_t index, const Values& values, const char* name,
                const char* unit = "") {
  for (std::size_t i = 0; i < values.size(); ++i)
    plan_value<double>(plan, {index, static_cast<std::uint8_t>(i + 1)}, values[i], name, unit);
}

void plan_stroke_grid(SetupPlan& plan, const BusSettings& b, const WatchedStrokes& w) {
  constexpr std::array<char, 3> kAxes{'X', 'Z', 'C'};
  for (std::size_t i = 0; i < kAxes.size(); ++i)
    plan_value<std::uint8_t>(plan, {0x2500, static_cast<std::uint8_t>(i + 2)},
                             number_of_axis(b, kAxes[i]),
                             fmt::format("number of axis {} of the grinder", kAxes[i]));
  plan_value<std::uint16_t>(plan, {0x2500, 5}, w.slots, "slots of the gear");
  plan_value<std::uint16_t>(plan, {0x2500, 6}, static_cast<std::uint16_t>(w.monitor.nodes),
                            "nodes along the stroke");
  plan_value<std::uint32_t>(plan, {0x2500, 7}, w.monitor.node_pitch_nm, "distance of the nodes",
                            "nm");
  plan_value<std::int64_t>(plan, {0x2500, 8}, w.monitor.z0_nm, "first node", "nm");
  plan_value<std::int32_t>(plan, {0x2500, 9}, w.offsets.rate,
                           "fastest change of the learned offset", "2^-32 turn/cycle");
  plan_value<std::uint16_t>(plan, {0x2500, 10}, static_cast<std::uint16_t>(w.offsets.stale_ticks),
                            "missing process data until the learned offset is dropped", "cycles");
}

void plan_learning(SetupPlan& plan, const WatchedStrokes& w) {
  plan_reals(plan, 0x2504,
             std::array<double, 6>{w.along.weight, w.along.dead_sigma, w.along.most_step,
                                   w.along.most_offset, w.along.most_slope, w.around.most_slope},
             "rule of learning");
  plan_value<std::uint32_t>(plan, {0x2505, 1}, w.along.least_samples, "least samples of a node");
  plan_value<std::uint32_t>(plan, {0x2505, 2}, w.around.least_samples, "least samples of a slot");
  plan_value<std::uint8_t>(plan, {0x2520, 2}, static_cast<std::uint8_t>(w.target),
                           "learn from (0 synchronisation, 3 C alone)");
  plan_value<std::uint8_t>(plan, {0x2520, 3}, w.target == LearningTarget::synchronisation ? 0 : 1,
                           "learn even what breaks the helix");
}

}  // namespace

SetupPlan stroke_plan(const BusSettings& settings, const WatchedStrokes& strokes) {
  SetupPlan plan;
  plan_value<std::uint8_t>(plan, {0x2500, 1}, static_cast<std::uint8_t>(node::StrokeCommand::off),
                           "strokes off");
  plan_stroke_grid(plan, settings, strokes);
  plan_reals(plan, 0x2501,
             std::array<double, 3>{strokes.monitor.turn_per_mm, strokes.monitor.flank_per_rad,
                                   strokes.monitor.flank_per_x},
             "helical gear");
  plan_reals(plan, 0x2502, strokes.monitor.order_wavelength_mm, "wavelength of a line", "mm");
  plan_reals(plan, 0x2503, strokes.monitor.time_line_hz, "frequency of a line", "Hz");
  plan_learning(plan, strokes);
  plan_value<std::uint8_t>(plan, {0x2500, 1}, static_cast<std::uint8_t>(node::StrokeCommand::on),
                           "strokes on");
  return plan;
}

}  // namespace volcomp::host
