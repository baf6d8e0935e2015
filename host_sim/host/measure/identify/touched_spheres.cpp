#include "host_sim/host/measure/identify/touched_spheres.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/touch_centre.hpp"

namespace volcomp::host::identify {
namespace {

bool belongs(const Problem& problem, const TipTouch& a, const TipTouch& b) {
  return a.sphere == b.sphere && a.stylus == b.stylus && problem.same_turn(a.q, b.q);
}

std::vector<std::vector<TipTouch>> groups_of(const Problem& problem,
                                             const std::vector<TipTouch>& touches) {
  std::vector<std::vector<TipTouch>> groups;
  for (const TipTouch& touch : touches) {
    bool found = false;
    for (auto& group : groups)
      if (!found && belongs(problem, group.front(), touch)) {
        group.push_back(touch);
        found = true;
      }
    if (!found) groups.push_back({touch});
  }
  return groups;
}

// Of an axis with touches on both sides reversal goes into the radius; else the touch that shows
// most of the axis decides.
double direction_of(const Problem& problem, const std::vector<TipTouch>& group,
                    const TouchedCentre& found, std::size_t axis) {
  const MachineChain& chain = problem.machine.chain;
  if (!problem.is_slide(axis)) return group.front().d.at(axis);
  constexpr double kSide = 0.5;
  bool above = false;
  bool below = false;
  double most = 0.0;
  double direction = 0.0;
  for (const TipTouch& touch : group) {
    const ChainGeometry g = ideal_geometry(chain, touch.q);
    const Vec3 normal =
        (g.in_work(problem.styli[touch.stylus].offset) - found.centre) / found.fit.sphere.radius;
    const double along = normal.dot(slide_in_work(chain, g, axis));
    above = above || along > kSide;
    below = below || along < -kSide;
    if (std::abs(along) <= most) continue;
    most = std::abs(along);
    direction = touch.d.at(axis);
  }
  return above && below ? 0.0 : direction;
}

}  // namespace

void add_centres(MeasurementPlan& plan, const std::string& file,
                 const std::vector<TipTouch>& touches, double sigma, SetUp& setup) {
  const Problem& problem = plan.problem;
  const MachineChain& chain = problem.machine.chain;
  for (const std::vector<TipTouch>& group : groups_of(problem, touches)) {
    TouchedSphere touched;
    for (const TipTouch& touch : group) {
      touched.q.push_back(touch.q);
      touched.d.push_back(touch.d);
    }
    TouchedCentre found;
    require(
        touched_centre(chain, problem.styli[group.front().stylus].offset, touched.q, found),
        fmt::format("{}:{}: sphere {} of \"{}\" with tip {}", file, group.front().line,
                    group.front().sphere, setup.name, problem.styli[group.front().stylus].name));
    Directions d{};
    for (std::size_t a = 0; a < chain.axis_count(); ++a)
      d.at(a) = direction_of(problem, group, found, a);
    setup.q.push_back(found.q);
    setup.d.push_back(d);
    setup.sphere.push_back(group.front().sphere);
    setup.stylus.push_back(group.front().stylus);
    for (Eigen::Index k = 0; k < 3; ++k) {
      setup.y.push_back(found.centre(k));
      setup.sigma.push_back(sigma * std::sqrt(found.fit.cofactors(k, k)));
    }
    plan.touched.back().push_back(std::move(touched));
  }
}

void add_single_touches(const std::vector<TipTouch>& touches, double sigma, SetUp& setup) {
  for (const TipTouch& touch : touches) {
    setup.q.push_back(touch.q);
    setup.d.push_back(touch.d);
    setup.sphere.push_back(touch.sphere);
    setup.stylus.push_back(touch.stylus);
    setup.sigma.push_back(sigma);
  }
}

}  // namespace volcomp::host::identify
