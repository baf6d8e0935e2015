#include "host_sim/host/report/volume_map.hpp"

#include <algorithm>
#include <cmath>

#include "comp/core/units.hpp"
#include "host_sim/host/report/report_parts.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

// 1, 2 or 5 times a power of ten, not above.
double rounded_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) return factor * power;
  }
  return power;
}

double magnification(const std::vector<Vec3>& points, const std::vector<VolumeArrows>& arrows) {
  constexpr double kShare = 0.2;  // of the shortest edge
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  double longest = 0.0;
  for (const VolumeArrows& a : arrows) {
    for (const Vec3& e : a.error)
      longest = std::max(longest, e.norm());
  }
  const double room = kShare * (high - low).minCoeff();
  return longest > 0.0 && room > 0.0 ? rounded_down(room / longest) : 1.0;
}

json coordinates(const std::vector<Vec3>& vectors, double scale) {
  json list = json::array();
  for (const Vec3& v : vectors)
    list.push_back({scale * v.x(), scale * v.y(), scale * v.z()});
  return list;
}

}  // namespace

json volume_map(const std::string& title, const std::vector<Vec3>& points,
                const std::vector<VolumeArrows>& arrows, const std::string& note) {
  json series = json::array();
  for (const VolumeArrows& a : arrows)
    series.push_back({{"name", a.name}, {"vectors", coordinates(a.error, kUmPerMm)}});
  return {{"type", "volume"},
          {"id", "volume"},
          {"title", title},
          {"x", axis_label("X", "mm")},
          {"y", axis_label("Y", "mm")},
          {"z", axis_label("Z", "mm")},
          {"unit", "µm"},
          {"points", coordinates(points, 1.0)},
          {"series", series},
          {"magnification", points.empty() ? 1.0 : magnification(points, arrows)},
          {"note", note}};
}

}  // namespace volcomp::host
