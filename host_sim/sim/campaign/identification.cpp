#include "host_sim/sim/campaign/identification.hpp"

#include <algorithm>

#include "comp/metrology/fits/axis_identification.hpp"

namespace volcomp::sim {
namespace {

std::vector<Vec3> measure(const TrueMachine& truth, std::size_t axis, const Pose& pose) {
  const host::AxisPlace place = host::place_in_branch(truth.chain, axis);
  const Frame moving =
      actual_frame(truth.chain, *place.path, place.before + 1, pose, truth.errors(pose, {}));
  std::vector<Vec3> measured;
  for (const Vec3& target : host::carried_targets())
    measured.push_back(moving.apply(target));
  return measured;
}

}  // namespace

double Identification::max_error() const {
  double worst = 0.0;
  for (std::size_t a = 0; a < found.axis.size(); ++a) {
    for (std::size_t i = 0; i < truth[a].size(); ++i)
      worst = std::max(worst, (found.axis[a].motion[i] - truth[a][i]).cwiseAbs().maxCoeff());
  }
  return worst;
}

Identification identify_axes(const TrueMachine& truth, const host::MachineFile& file) {
  Identification result;
  result.found = host::identify_axes(
      file, [&truth](std::size_t axis, const Pose& pose) { return measure(truth, axis, pose); });
  const Pose reference = host::reference_pose(file);
  for (std::size_t a = 0; a < result.found.axis.size(); ++a) {
    std::vector<ErrorMotion>& at_nodes = result.truth.emplace_back();
    for (const double q : result.found.axis[a].nodes) {
      Pose pose = reference;
      pose[a] = q;
      at_nodes.push_back(truth.errors(pose, {})[a]);
    }
  }
  return result;
}

}  // namespace volcomp::sim
