#include "host_sim/host/bus/probe_setup.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kNsPerUs = 1e3;

void plan_ns(SetupPlan& plan, canopen::ObjectId object, double us, std::string name) {
  plan_value<std::uint32_t>(plan, object, static_cast<std::uint32_t>(std::llround(us * kNsPerUs)),
                            std::move(name), "ns");
}

void plan_nm(SetupPlan& plan, const node::object_lines::Handle<double>& object, double mm,
             const char* name) {
  plan_value(plan, object, kNmPerMm * mm, name, "nm");
}

void plan_frame(SetupPlan& plan, const Frame& frame) {
  std::size_t next = 0;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c)
      plan_value(plan, node::object::probe::workpiece[next++], frame.R(r, c),
                 "rotation of the part");
  }
  for (Eigen::Index r = 0; r < 3; ++r)
    plan_nm(plan, node::object::probe::workpiece[next++], frame.t(r), "origin of the part");
}

void plan_gear(SetupPlan& plan, const NodeProbe& probe) {
  const FaceGear& g = probe.gear;
  const std::array<double, 11> numbers{static_cast<double>(g.shaper_teeth),
                                       static_cast<double>(g.teeth),
                                       g.module,
                                       g.pressure_angle,
                                       g.addendum,
                                       g.shaper_addendum,
                                       g.r_in,
                                       g.r_out,
                                       g.relief.amount,
                                       g.relief.begin,
                                       g.relief.length};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    plan_value(plan, node::object::probe::gear_number[i], numbers[i], "number of the face gear");
  plan_value(plan, node::object::probe::gear, probe.gear_id, "face gear");
}

}  // namespace

NodeProbe node_probe(const MachineFile& machine) {
  if (!machine.probe) throw UserError(machine.path + ": the machine has no [probe]");
  NodeProbe probe;
  probe.delay_us = machine.probe->delay_us;
  probe.radius.coefficient[0] = machine.probe->radius_mm;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    probe.latch_delay_us[a] = machine.axes[a].latch_delay_us;
  return probe;
}

SetupPlan probe_plan(const NodeProbe& probe) {
  SetupPlan plan;
  plan_ns(plan, node::object::probe::delay_ns.id(), probe.delay_us,
          "delay from the contact to the edge");
  for (std::size_t a = 0; a < node::kNodeAxes; ++a)
    plan_ns(plan, node::object::probe::latch_delay_ns[a].id(), probe.latch_delay_us[a],
            fmt::format("delay from the edge to the latch of axis {}", a + 1));
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    plan_nm(plan, node::object::probe::lobing[k], probe.radius.coefficient[k],
            "effective radius, by direction");
  plan_frame(plan, probe.workpiece);
  plan_nm(plan, node::object::probe::uncertainty[0], probe.radius_uncertainty,
          "standard uncertainty of the radius");
  plan_nm(plan, node::object::probe::uncertainty[1], probe.tool_length_uncertainty,
          "standard uncertainty of the tool length");
  plan_nm(plan, node::object::probe::uncertainty[3], probe.repeatability,
          "repeatability of the probe");
  if (probe.gear_id != 0) plan_gear(plan, probe);
  plan_value(plan, node::object::probe::command, static_cast<std::uint8_t>(node::ProbeCommand::on),
             "probe on with these settings");
  return plan;
}

}  // namespace volcomp::host
