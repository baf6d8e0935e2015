#include "host_sim/sim/campaign/tracer_stations.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"

namespace volcomp::sim {

namespace identify = host::identify;

identify::Machine machine_of(const host::MachineFile& file) {
  identify::Machine machine;
  machine.chain = file.chain;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const host::AxisFile& axis = file.axes[a];
    machine.travel.at(a) = {axis.lo, axis.hi, axis.reference, axis.full_turn()};
  }
  return machine;
}

std::vector<Vec3> stations_about(const identify::Machine& machine) {
  constexpr std::size_t kSamples = 200;
  constexpr double kBeyond = 1.5;  // of the farthest place
  const Vec3 tool = machine.chain.tool_point();
  std::vector<Vec3> at;
  for (const Pose& q : identify::places_of(machine, kSamples))
    at.push_back(identify::ideal_geometry(machine.chain, q).in_work(tool));
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : at)
    centre += p / static_cast<double>(kSamples);
  double farthest = 0.0;
  for (const Vec3& p : at)
    farthest = std::max(farthest, (p - centre).norm());
  std::vector<Vec3> stations;
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
    stations.emplace_back(centre + kBeyond * farthest / std::sqrt(3.0) * corner);
  return stations;
}

}  // namespace volcomp::sim
