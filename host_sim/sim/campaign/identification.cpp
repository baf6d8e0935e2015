#include "host_sim/sim/campaign/identification.hpp"

#include <algorithm>

#include "comp/metrology/fits/axis_identification.hpp"
#include "comp/metrology/statistics/random_stream.hpp"

namespace volcomp::sim {
namespace {

class Tracker {
 public:
  Tracker(const TrueMachine& truth, const TrackerScatter& scatter)
      : truth_(truth), scatter_(scatter) {}

  [[nodiscard]] std::vector<Vec3> measure(std::size_t axis, const Pose& pose) {
    const host::AxisPlace place = host::place_in_branch(truth_.chain, axis);
    const Frame moving =
        actual_frame(truth_.chain, *place.path, place.before + 1, pose, truth_.errors(pose, {}));
    std::vector<Vec3> measured;
    for (const Vec3& target : host::carried_targets())
      measured.emplace_back(moving.apply(target) + noise(axis));
    return measured;
  }

 private:
  // Readings of an axis count on, in the order in which its targets are read.
  [[nodiscard]] Vec3 noise(std::size_t axis) {
    if (!(scatter_.sigma > 0.0)) return Vec3::Zero();
    Vec3 n;
    for (Eigen::Index k = 0; k < 3; ++k)
      n(k) =
          scatter_.sigma *
          normal(scatter_.seed, {static_cast<std::uint32_t>(RandomStream::tracker), scatter_.draw,
                                 static_cast<std::uint32_t>(axis), reading_.at(axis)++});
    return n;
  }

  const TrueMachine& truth_;
  TrackerScatter scatter_;
  std::array<std::uint32_t, kMaxAxes> reading_{};
};

}  // namespace

double Identification::max_error() const {
  double worst = 0.0;
  for (std::size_t a = 0; a < found.axis.size(); ++a) {
    for (std::size_t i = 0; i < truth[a].size(); ++i)
      worst = std::max(worst, (found.axis[a].motion[i] - truth[a][i]).cwiseAbs().maxCoeff());
  }
  return worst;
}

Identification identify_axes(const TrueMachine& truth, const host::MachineFile& file,
                             const TrackerScatter& scatter) {
  Identification result;
  Tracker tracker(truth, scatter);
  result.found = host::identify_axes(
      file, [&](std::size_t axis, const Pose& pose) { return tracker.measure(axis, pose); });
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
