#include "host_sim/host/measure/ball_bar/ball_bar_circles.hpp"

#include <cmath>

#include "comp/core/units.hpp"
#include "comp/metrology/circles/circle_figures.hpp"

namespace volcomp::host {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kTurn = 2.0 * kPi;
constexpr double kLeastFeed = 0.1;  // mm/min
constexpr double kMostFeed = 1e6;
constexpr double kShortestWave = 0.01;  // mm
constexpr double kMostDeviation = 2.0;  // mm: a bar reads no more, whole lengths are longer
constexpr std::size_t kLeastReadings = 36;
constexpr double kWidestGap = 10.0 * kDegree;
constexpr double kShortestArc = 180.0 * kDegree;
constexpr double kFarthestSocket = 1.0;  // mm
constexpr double kRounding = 1e-9;       // rad, of angles that are sums

bool is_plane(const std::string& plane) {
  return plane.size() == 2 && plane[0] >= 'X' && plane[0] <= 'Z' && plane[1] >= 'X' &&
         plane[1] <= 'Z' && plane[0] != plane[1];
}

Status missing(const char* field) {
  Where where;
  where.field = field;
  return refuse(Reason::missing_field, where);
}

bool any_reading(const BallBarTest& test) {
  for (const auto& direction : test.circle)
    for (const BallBarCircle& circle : direction)
      if (!circle.radial.empty()) return true;
  return false;
}

Status check_settings(const BallBarTest& test) {
  if (!test.plane) return missing("plane");
  if (!test.radius) return missing("radius_mm");
  if (test.circle[0].empty() && test.circle[1].empty()) return missing("theta");
  if (!any_reading(test)) return missing("radial");
  if (!is_plane(*test.plane)) {
    Where where;
    where.field = "plane";
    return refuse(Reason::unknown_plane, where);
  }
  if (!(*test.radius >= kLeastCircle && *test.radius <= kMostCircle))
    return refuse_value(Reason::bad_setting, "radius_mm", *test.radius);
  if (!test.feed && test.both()) return missing("feed_mm_min");
  if (test.feed && !(*test.feed >= kLeastFeed && *test.feed <= kMostFeed))
    return refuse_value(Reason::bad_setting, "feed_mm_min", *test.feed);
  for (const double wavelength : test.cyclic) {
    const bool none = !(wavelength > 0.0) && !(wavelength < 0.0);
    if (!none && !(wavelength >= kShortestWave && wavelength <= *test.radius))
      return refuse_value(Reason::bad_setting, "cyclic_mm", wavelength);
  }
  return {};
}

// One circle, of a direction with the sense 1 (ccw) or −1.
class CircleCheck {
 public:
  CircleCheck(const BallBarTest& test, std::size_t direction, const BallBarCircle& circle)
      : test_(test), circle_(circle), ccw_(direction == 0) {
    where_.direction = kCircleDirections.at(direction);
    where_.run = static_cast<int>(circle.run) - 1;
  }

  [[nodiscard]] Status run() {
    const CircleTest one = alone();
    if (const Status s = check_readings(one, 0); !s.ok())
      return refused(s.reason, s.where.index, s.where.field);
    const std::vector<double>& theta = circle_.theta;
    for (std::size_t i = 0; i < theta.size(); ++i)
      if (!(std::abs(circle_.radial[i]) <= kMostDeviation))
        return refused(Reason::unit_suspected, i);
    for (std::size_t i = 1; i < theta.size(); ++i)
      if (!(step(i) > 0.0)) return refused(Reason::positions_not_monotone, i);
    if (theta.size() < kLeastReadings) {
      where_.count = static_cast<int>(theta.size());
      return refuse(Reason::too_few_points, where_);
    }
    for (std::size_t i = 1; i < theta.size(); ++i)
      if (step(i) > kWidestGap + kRounding) return refused(Reason::gap, i);
    if (std::abs(theta.back() - theta.front()) < kShortestArc - kRounding)
      return refuse(Reason::arc_too_short, where_);
    CircleFigures figures;
    if (const Status s = circle_figures(one, figures); !s.ok()) return s;
    if (!(std::hypot(figures.centre[0], figures.centre[1]) <= kFarthestSocket))
      return refuse(Reason::off_centre, where_);
    return {};
  }

 private:
  [[nodiscard]] CircleTest alone() const {
    return ccw_ ? CircleTest{*test_.radius, circle_.trace(), {}}
                : CircleTest{*test_.radius, {}, circle_.trace()};
  }
  [[nodiscard]] double step(std::size_t i) const {
    return (ccw_ ? 1.0 : -1.0) * (circle_.theta[i] - circle_.theta[i - 1]);
  }
  template <class Index>
  Status refused(Reason reason, Index index, const char* field = nullptr) {
    where_.index = static_cast<int>(index);
    where_.field = field;
    return refuse(reason, where_);
  }

  const BallBarTest& test_;
  const BallBarCircle& circle_;
  bool ccw_;
  Where where_;
};

}  // namespace

bool BallBarCircle::full() const {
  if (theta.size() < 2) return false;
  const double travelled = std::abs(theta.back() - theta.front());
  const auto n = static_cast<double>(theta.size());
  return travelled * n / (n - 1.0) >= kTurn - kDegree;
}

Status check(const BallBarTest& test) {
  if (const Status s = check_settings(test); !s.ok()) return s;
  for (std::size_t direction = 0; direction < test.circle.size(); ++direction) {
    for (const BallBarCircle& circle : test.circle[direction]) {
      if (const Status s = CircleCheck(test, direction, circle).run(); !s.ok()) return s;
    }
  }
  return {};
}

CircleSettings circle_settings(const BallBarTest& test) {
  CircleSettings settings;
  settings.first = static_cast<Axis>((*test.plane)[0] - 'X');
  settings.second = static_cast<Axis>((*test.plane)[1] - 'X');
  settings.feed = test.feed.value_or(0.0) / 60.0;
  settings.cyclic_wavelength = test.cyclic;
  return settings;
}

const char* squareness_name(const CircleSettings& settings) {
  const auto has = [&](Axis axis) { return settings.first == axis || settings.second == axis; };
  if (!has(Axis::z)) return "EC0Y";
  return has(Axis::x) ? "EB0Z" : "EA0Z";
}

}  // namespace volcomp::host
