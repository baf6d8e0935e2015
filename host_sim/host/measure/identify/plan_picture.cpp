#include "host_sim/host/measure/identify/plan_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host::identify {
namespace {

using nlohmann::json;

struct Places {
  json points = json::array();
  json labels = json::array();

  void add(const Vec3& p, const std::string& label) {
    points.push_back({p.x(), p.y(), p.z()});
    labels.push_back(label);
  }
  [[nodiscard]] json series(const std::string& name, const char* style) const {
    return {{"name", name}, {"points", points}, {"labels", labels}, {"style", style}};
  }
};

// Observations at one place of the work frame are one point: of a sphere, with all tips that touch
// it; of other instruments, with all their passes.
struct AtPlace {
  Vec3 point = Vec3::Zero();
  std::string sphere;
  std::set<std::string> tips;
  std::size_t count = 0;

  [[nodiscard]] std::string label() const {
    std::string text = sphere;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (!tips.empty()) add(fmt::format("tip {}", fmt::join(tips, " ")));
    if (sphere.empty() && count > 1) add(fmt::format("{} times", count));
    return text.empty() ? "one observation" : text;
  }
};

Places observed(const Problem& problem, const SetUp& s) {
  constexpr double kSame_mm = 0.5;
  using Key = std::array<long, 4>;
  std::map<Key, AtPlace> places;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const Vec3 p = ideal_geometry(problem.machine.chain, s.q[i]).in_work(problem.tip_of(s, i));
    Key key{};
    if (!s.sphere.empty()) {
      key[0] = static_cast<long>(s.sphere[i]);
    } else {
      for (Eigen::Index k = 0; k < 3; ++k)
        key.at(static_cast<std::size_t>(k) + 1) = std::lround(p(k) / kSame_mm);
    }
    AtPlace& at = places[key];
    if (at.count++ == 0) at.point = p;
    if (!s.sphere.empty()) at.sphere = fmt::format("sphere {}", s.sphere[i]);
    if (const auto stylus = problem.stylus_of(s, i)) at.tips.insert(problem.styli[*stylus].name);
  }
  Places out;
  for (const auto& entry : places)
    out.add(entry.second.point, entry.second.label());
  return out;
}

// A station on the bed is shown where the work sees it with its axes in the middle of their travel.
void add_station(const Problem& problem, const SetUp& s, Places& stations) {
  if (!s.station) return;
  const ChainGeometry g = ideal_geometry(problem.machine.chain, middle_of(problem));
  const bool bar = s.kind == ObservationKind::bar;
  stations.add(s.in_bed ? g.work.apply_inverse(*s.station) : *s.station,
               fmt::format("{} of {}{}", bar ? "socket" : "station", s.name,
                           s.in_bed ? ", on the bed" : ""));
}

// Spheres where the plan places them, of which no tip comes to the centre.
void add_untouched(const Problem& problem, const SetUp& s, Places& untouched) {
  if (!s.pose || !s.artefact) return;
  const Artefact& artefact = problem.artefacts[*s.artefact];
  for (std::size_t k = 0; k < artefact.spheres.size(); ++k)
    if (std::find(s.sphere.begin(), s.sphere.end(), k) == s.sphere.end())
      untouched.add(s.pose->R * artefact.spheres[k] + s.pose->t,
                    fmt::format("sphere {} of {}", k, s.name));
}

json travel_box(const Problem& problem) {
  const MachineChain& chain = problem.machine.chain;
  Vec3 low = Vec3::Constant(HUGE_VAL);
  Vec3 high = Vec3::Constant(-HUGE_VAL);
  for (std::size_t corner = 0; corner < std::size_t{1} << chain.axis_count(); ++corner) {
    Pose q = middle_of(problem);
    for (std::size_t a = 0; a < chain.axis_count(); ++a) {
      const Travel& travel = problem.machine.travel.at(a);
      if (problem.is_slide(a)) q.at(a) = (corner >> a & 1U) != 0 ? travel.hi : travel.lo;
    }
    const Vec3 p = ideal_geometry(chain, q).in_work(chain.tool_point());
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  json box = json::array();
  for (Eigen::Index k = 0; k < 3; ++k)
    box.push_back(json::array({low(k), high(k)}));
  return box;
}

}  // namespace

json plan_picture(const MeasurementPlan& plan) {
  const Problem& problem = plan.problem;
  json series = json::array();
  Places stations;
  Places untouched;
  for (const SetUp& s : problem.setups) {
    series.push_back(observed(problem, s).series(s.name, "solid"));
    add_station(problem, s, stations);
    add_untouched(problem, s, untouched);
  }
  if (!stations.points.empty()) series.push_back(stations.series("stations and sockets", "open"));
  if (!untouched.points.empty()) series.push_back(untouched.series("spheres out of reach", "open"));
  return with_id("plan",
                 {{"type", "places"},
                  {"title", "The plan in the work frame"},
                  {"x", axis_label("X", "mm")},
                  {"y", axis_label("Y", "mm")},
                  {"z", axis_label("Z", "mm")},
                  {"box", travel_box(problem)},
                  {"series", std::move(series)}},
                 "Places of the tips, spheres by their number. The box is the travel of the "
                 "functional point, with rotary axes at their reference: longer and shorter tips "
                 "reach beyond it.");
}

}  // namespace volcomp::host::identify
