#include "host_sim/host/measure/identify/touch_centre.hpp"

namespace volcomp::host::identify {

Status touched_centre(const MachineChain& chain, const Vec3& tip, const std::vector<Pose>& q,
                      TouchedCentre& out) {
  if (q.size() < kLeastTouches) {
    Where where;
    where.count = static_cast<int>(q.size());
    return refuse(Reason::too_few_touches, where);
  }
  std::vector<Vec3> points;
  out.q = Pose{};
  for (const Pose& pose : q) {
    points.push_back(ideal_geometry(chain, pose).in_work(tip));
    for (std::size_t a = 0; a < chain.axis_count(); ++a)
      out.q.at(a) += pose.at(a) / static_cast<double>(q.size());
  }
  if (const Status s = fit_sphere({points.data(), points.size()}, out.fit); !s.ok()) return s;
  out.centre = out.fit.sphere.centre;
  const ChainGeometry mean = ideal_geometry(chain, out.q);
  if (!move_by(chain, mean, out.centre - mean.in_work(tip), out.q))
    return refuse(Reason::no_authority);
  return {};
}

Status refined_centre(const MachineChain& chain, const Vec3& tip, const std::vector<Pose>& q,
                      const std::vector<ErrorSet>& errors, const Pose& q_centre,
                      const ErrorSet& errors_centre, Vec3& out) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < q.size(); ++i)
    points.push_back(actual_tips(chain, q[i], errors[i]).in_work(tip));
  SphereFit fit;
  if (const Status s = fit_sphere({points.data(), points.size()}, fit); !s.ok()) return s;
  const Vec3 error = actual_tips(chain, q_centre, errors_centre).in_work(tip) -
                     ideal_geometry(chain, q_centre).in_work(tip);
  out = fit.sphere.centre - error;
  return {};
}

}  // namespace volcomp::host::identify
