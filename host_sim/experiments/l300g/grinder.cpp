#include "host_sim/experiments/l300g/grinder.hpp"

#include <cmath>
#include <utility>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/tables/build_tables.hpp"

namespace volcomp::l300g {
GrinderGeometry grinder_geometry(const MachineChain& chain) {
  GrinderGeometry g;
  g.arm.length = -chain.tool_point().x();
  // The joint of B is turned back by its reading with the arm level.
  const std::array<double, 9>& turned = chain.axis(2).orientation;
  g.arm.zero = std::atan2(-turned[2], turned[0]);
  const std::array<double, 3>& offset = chain.axis(0).offset;
  g.datum = {g.arm.length - offset[0], -offset[1]};
  return g;
}

MachineDescription with_origin(const MachineChain& chain, double y0, double z0) {
  MachineDescription description = chain.description();
  std::array<double, 3>& offset = description.body.at(chain.body_of_axis(0)).joint.offset;
  offset[1] = -y0;
  offset[2] = -z0;
  return description;
}

Grinder::Grinder(const GrinderHall& hall, const MachineTables& tables) : hall_(hall) {
  host::require(MachineChain::build(tables.machine, chain_), hall.file.path);
  geometry_ = grinder_geometry(chain_);
  auto axes =
      hall.make_axes(host::bus_settings(hall.file, hall.cycle_hz), host::make_image(tables));
  axes_ = axes.get();
  axes_->controller().use_probe(host::node_probe(hall.file));
  cell_ = std::make_unique<sim::MotionCell>(hall.truth, std::move(axes));
  cell_->place(clear_of_work(kFarAway_mm));
  prober_ = std::make_unique<sim::Prober>(*cell_, *axes_, hall.file);
}

void Grinder::mount(const sim::Artefact& artefact, Mounted as,
                    std::function<double(const Vec3&)> lobing_mm) {
  const host::NodeProbe described = host::node_probe(hall_.file);
  sim::TouchProbe::Settings probe;
  probe.radius_mm = described.radius.coefficient[0];
  probe.lobing_mm = lobing_mm;
  probe.delay_ns = std::llround(1e3 * described.delay_us);
  const ProbeScatter& scatter = hall_.scatter;
  if (const double sigma = scatter.probe.noise.sigma(); sigma > 0.0) {
    if (!lobing_mm) scatter.probe.give_to(probe);
    probe.scatter_mm = [sigma, seed = scatter.seed, draw = scatter.draw, as](std::uint32_t touch) {
      return sigma * normal(seed, {static_cast<std::uint32_t>(RandomStream::probe), draw,
                                   static_cast<std::uint32_t>(as), touch});
    };
  }
  axes_->mount(sim::TouchProbe(hall_.truth, artefact, probe));
}

Pose Grinder::clear_of_work(double away_mm) const {
  return {geometry_.datum.x, geometry_.datum.y + away_mm, geometry_.arm.zero, 0.0};
}

}  // namespace volcomp::l300g
