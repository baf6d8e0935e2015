#include "host_sim/host/bus/probe_setup.hpp"

#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "firmware/node/node_objects.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

namespace probing = node::object::probe;

constexpr double kNsPerUs = 1e3;

std::uint32_t ns(double us) { return static_cast<std::uint32_t>(std::llround(us * kNsPerUs)); }

void plan_nm(SetupPlan& plan, const canopen::object_lines::Handle<double>& object, double mm) {
  plan_value(plan, object, kNmPerMm * mm, "nm");
}

void plan_frame(SetupPlan& plan, const Frame& frame) {
  std::size_t next = 0;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c)
      plan_value(plan, probing::workpiece[next++], frame.R(r, c));
  }
  for (Eigen::Index r = 0; r < 3; ++r)
    plan_nm(plan, probing::workpiece[next++], frame.t(r));
}

void plan_gear(SetupPlan& plan, const NodeProbe& probe) {
  const FaceGear& g = probe.gear;
  plan_values(plan, probing::gear_number,
              std::array{static_cast<double>(g.shaper_teeth), static_cast<double>(g.teeth),
                         g.module, g.pressure_angle, g.addendum, g.shaper_addendum, g.r_in, g.r_out,
                         g.relief.amount, g.relief.begin, g.relief.length});
  plan_value(plan, probing::gear, probe.gear_id);
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
  plan_value(plan, probing::delay_ns, ns(probe.delay_us));
  for (std::size_t a = 0; a < node::kNodeAxes; ++a)
    plan_value(plan, probing::latch_delay_ns[a], ns(probe.latch_delay_us[a]));
  for (std::size_t k = 0; k < kLobingTerms; ++k)
    plan_nm(plan, probing::lobing[k], probe.radius.coefficient[k]);
  plan_frame(plan, probe.workpiece);
  plan_nm(plan, probing::uncertainty[0], probe.radius_uncertainty);
  plan_nm(plan, probing::uncertainty[1], probe.tool_length_uncertainty);
  plan_nm(plan, probing::uncertainty[3], probe.repeatability);
  if (probe.gear_id != 0) plan_gear(plan, probe);
  plan_value(plan, probing::command, static_cast<std::uint8_t>(node::ProbeCommand::on));
  return plan;
}

}  // namespace volcomp::host
