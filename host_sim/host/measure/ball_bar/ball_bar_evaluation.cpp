#include "host_sim/host/measure/ball_bar/ball_bar_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "comp/metrology/circles/centred_fit.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

constexpr double kSameAngle = 1e-6;  // rad
constexpr double kFarSocket = 0.1;   // mm
constexpr double kTurn = 2.0 * kPi;
// Draws times readings of both directions: some seconds, and memory of 320 MB.
constexpr std::size_t kMostNumbers = 8'000'000;
constexpr std::size_t kFewestDraws = 400;

void require_same_angles(const BallBarTest& test, const BallBarCircle& first,
                         const BallBarCircle& other, const char* direction) {
  const bool alike = first.theta.size() == other.theta.size() &&
                     std::equal(first.theta.begin(), first.theta.end(), other.theta.begin(),
                                [](double a, double b) {
                                  return std::abs(std::remainder(a - b, kTurn)) < kSameAngle;
                                });
  if (alike) return;
  throw UserError(fmt::format(
      "{}: {}: circle {} has other angles than circle {}; circles of one direction are read at the "
      "same angles",
      test.name, direction, other.run, first.run));
}

CirclePath mean_path(const BallBarTest& test, std::size_t direction) {
  const std::vector<BallBarCircle>& circles = test.circle.at(direction);
  CirclePath path;
  path.theta = circles.front().theta;
  path.radial.assign(path.theta.size(), 0.0);
  for (const BallBarCircle& c : circles) {
    require_same_angles(test, circles.front(), c, kCircleDirections.at(direction));
    for (std::size_t i = 0; i < path.radial.size(); ++i)
      path.radial[i] += c.radial[i] / static_cast<double>(circles.size());
  }
  path.centred.resize(path.theta.size());
  path.residual.resize(path.theta.size());
  return path;
}

class Evaluation {
 public:
  Evaluation(const BallBarTest& test, const BallBarSettings& settings)
      : test_(test), settings_(settings) {}

  BallBarEvaluation run() {
    decompose();
    for (auto& path : e_.path)
      if (path) path->spikes = circle_spikes(path->theta, path->residual);
    take_figures();
    e_.u_squareness = std::max(e_.decomposition.u.squareness, spread_of_squareness());
    e_.sensor_squareness = 2.0 * kBallBarSensor / *test_.radius;
    take_intervals();
    remark();
    return std::move(e_);
  }

  CircleDecomposition decompose() {
    e_.settings = circle_settings(test_);
    e_.squareness = squareness_name(e_.settings);
    for (std::size_t d = 0; d < e_.path.size(); ++d) {
      if (test_.circle.at(d).empty()) continue;
      e_.path.at(d) = mean_path(test_, d);
      e_.full = e_.full && test_.circle.at(d).front().full();
    }
    const auto residual = [&](std::size_t d) {
      return e_.path.at(d) ? Span<double>(e_.path.at(d)->residual) : Span<double>();
    };
    require(decompose_circle({*test_.radius, trace(0), trace(1)}, e_.settings,
                             {residual(0), residual(1)}, e_.decomposition),
            test_.name);
    if (!std::isfinite(e_.decomposition.value.squareness) ||
        !std::isfinite(e_.decomposition.u.squareness))
      throw UserError(test_.name + ": the readings do not determine the parts of the form");
    return e_.decomposition;
  }

 private:
  [[nodiscard]] CircleTrace trace(std::size_t d) const {
    if (!e_.path.at(d)) return {};
    return {e_.path.at(d)->theta, e_.path.at(d)->radial};
  }

  void take_figures() {
    for (std::size_t d = 0; d < e_.path.size(); ++d) {
      if (!e_.path.at(d)) continue;
      CirclePath& path = *e_.path.at(d);
      CircleTest one{*test_.radius, {}, {}};
      (d == 0 ? one.ccw : one.cw) = trace(d);
      require(circle_figures(one, path.figures), test_.name);
      const Eigen::Vector2d centre(path.figures.centre[0], path.figures.centre[1]);
      for (std::size_t i = 0; i < path.theta.size(); ++i)
        path.centred[i] = path_deviation(*test_.radius, path.theta[i], path.radial[i], centre);
    }
    if (!test_.both()) return;
    CircleFigures figures;
    require(circle_figures({*test_.radius, trace(0), trace(1)}, figures), test_.name);
    e_.both = figures;
  }

  // Of the mean over circles, from how much the single ones differ: residuals are form of the
  // machine and not independent. 0: one circle, or circles that are no pairs.
  [[nodiscard]] double spread_of_squareness() const {
    if (!paired()) return 0.0;
    const std::size_t n = std::max(test_.circle[0].size(), test_.circle[1].size());
    if (n < 2) return 0.0;
    std::vector<double> each;
    for (std::size_t run = 0; run < n; ++run) {
      CircleTest one{*test_.radius, {}, {}};
      if (!test_.circle[0].empty()) one.ccw = test_.circle[0][run].trace();
      if (!test_.circle[1].empty()) one.cw = test_.circle[1][run].trace();
      CircleDecomposition d;
      require(decompose_circle(one, e_.settings, {}, d), test_.name);
      each.push_back(d.value.squareness);
    }
    const auto count = static_cast<double>(n);
    const double mean = std::accumulate(each.begin(), each.end(), 0.0) / count;
    double squares = 0.0;
    for (const double x : each)
      squares += (x - mean) * (x - mean);
    return std::sqrt(squares / (count - 1.0) / count);
  }

  // Whether both directions have the same runs, or there is one direction only.
  [[nodiscard]] bool paired() const {
    if (!test_.both()) return true;
    return std::equal(test_.circle[0].begin(), test_.circle[0].end(), test_.circle[1].begin(),
                      test_.circle[1].end(), [](const BallBarCircle& a, const BallBarCircle& b) {
                        return a.run == b.run;
                      });
  }

  // Readings of a direction by rising angle within a turn.
  [[nodiscard]] static std::vector<std::size_t> by_angle(const std::vector<double>& theta) {
    std::vector<std::size_t> order(theta.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return in_turn(theta[a]) < in_turn(theta[b]); });
    return order;
  }
  static double in_turn(double theta) {
    const double rest = theta - kTurn * std::floor(theta / kTurn);
    return rest >= kTurn - kSameAngle ? 0.0 : rest;
  }

  void take_intervals() {
    if (!test_.both()) {
      if (settings_.sigma > 0.0)
        e_.remarks.emplace_back("one direction only: no intervals, stated scatter or not");
      return;
    }
    const std::string why = no_interval();
    if (!why.empty()) {
      e_.remarks.push_back(why);
      return;
    }
    const CircleRuns runs = runs_by_angle();
    e_.draws = affordable_draws(2 * runs.theta.size());
    if (e_.draws > 0) e_.intervals = circle_intervals(runs, settings_.seed, e_.draws);
  }

  // Why there is none of both directions; empty: there is one.
  std::string no_interval() {
    const bool stated = settings_.sigma > 0.0;
    if (!paired())
      return fmt::format("{} No intervals. [{}]", sentence(Reason::run_count_differs),
                         code(Reason::run_count_differs));
    const std::size_t n = test_.circle[0].size();
    if (n < 2 && !stated)
      return "one circle each way: no spread, so no interval; G of noisy readings is too large";
    if (!same_angles())
      return "the two directions are not read at the same angles: no intervals of G";
    if (n > 1 && stated)
      e_.remarks.emplace_back("the stated scatter is not used: the circles show their own");
    if (n > 1 && all_alike())
      return fmt::format("{} [{}]", sentence(Reason::no_spread), code(Reason::no_spread));
    return "";
  }

  [[nodiscard]] bool same_angles() const {
    const std::vector<double>& ccw = e_.path[0]->theta;
    const std::vector<double>& cw = e_.path[1]->theta;
    if (ccw.size() != cw.size()) return false;
    const auto a = by_angle(ccw);
    const auto b = by_angle(cw);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(std::abs(in_turn(ccw[a[i]]) - in_turn(cw[b[i]])) < kSameAngle)) return false;
    return true;
  }

  [[nodiscard]] CircleRuns runs_by_angle() const {
    const auto ccw = by_angle(e_.path[0]->theta);
    const auto cw = by_angle(e_.path[1]->theta);
    CircleRuns runs;
    runs.radius = *test_.radius;
    runs.sigma = test_.circle[0].size() < 2 ? settings_.sigma : 0.0;
    for (const std::size_t i : ccw)
      runs.theta.push_back(in_turn(e_.path[0]->theta[i]));
    for (std::size_t run = 0; run < test_.circle[0].size(); ++run) {
      runs.ccw.push_back(sorted(test_.circle[0][run].radial, ccw));
      runs.cw.push_back(sorted(test_.circle[1][run].radial, cw));
    }
    return runs;
  }

  // 0: too many readings.
  std::size_t affordable_draws(std::size_t readings) {
    const std::size_t draws = std::min(settings_.draws, kMostNumbers / readings);
    if (draws < std::min(settings_.draws, kFewestDraws)) {
      e_.remarks.push_back(
          fmt::format("more than {} readings of a circle: no intervals; a few hundred tell as much",
                      kMostNumbers / kFewestDraws / 2));
      return 0;
    }
    if (draws < settings_.draws)
      e_.remarks.push_back(fmt::format("{} draws instead of {}, because of {} readings", draws,
                                       settings_.draws, readings));
    return draws;
  }

  static std::vector<double> sorted(const std::vector<double>& values,
                                    const std::vector<std::size_t>& order) {
    std::vector<double> out;
    out.reserve(order.size());
    for (const std::size_t i : order)
      out.push_back(values[i]);
    return out;
  }
  // Beside where the socket is and how long the bar is taken for: what is left of a copied circle
  // is rounding.
  [[nodiscard]] bool all_alike() const {
    constexpr double kRounding = 1e-8;  // mm, a hundredth of a nanometre
    const std::vector<double> first = form_of(0);
    for (std::size_t run = 1; run < test_.circle[0].size(); ++run) {
      const std::vector<double> other = form_of(run);
      for (std::size_t i = 0; i < first.size(); ++i)
        if (std::abs(other[i] - first[i]) > kRounding) return false;
    }
    return true;
  }

  // Deviations of both circles of a run about their own centre and mean radius.
  [[nodiscard]] std::vector<double> form_of(std::size_t run) const {
    const CircleTest one{*test_.radius, test_.circle[0][run].trace(), test_.circle[1][run].trace()};
    CircleFigures figures;
    require(circle_figures(one, figures), test_.name);
    const Eigen::Vector2d centre(figures.centre[0], figures.centre[1]);
    std::vector<double> form;
    for_each_reading(one, [&](double theta, double radial, double /*sense*/) {
      form.push_back(path_deviation(*test_.radius, theta, radial, centre) -
                     figures.radius_deviation);
    });
    return form;
  }

  void remark() {
    const CircleParameters& p = e_.decomposition.value;
    const double off = std::hypot(p.centre[0], p.centre[1]);
    if (off > kFarSocket)
      e_.remarks.push_back(fmt::format("the socket is {:.3f} mm off the centre", off));
    if (!e_.full)
      e_.remarks.emplace_back(
          "arc: G(b) and D as far as it goes; a bow of the axes leaks into the squareness, whose "
          "uncertainty is larger than on a full circle");
    if (!test_.both())
      e_.remarks.emplace_back(
          "one direction only: servo mismatch is not separable from squareness; reversal and "
          "lateral play are unknown");
    if (test_.calibrated && !test_.temperature)
      e_.remarks.emplace_back(
          "the temperature is not stated: D contains the growth of bar and machine");
    if (test_.overshoot > 0)
      e_.remarks.push_back(
          fmt::format("{} readings beyond a full turn are left out; several "
                      "circles need \"# run\" before each",
                      test_.overshoot));
  }

  const BallBarTest& test_;
  BallBarSettings settings_;
  BallBarEvaluation e_;
};

}  // namespace

CircleDecomposition decompose_ball_bar(const BallBarTest& test) {
  require(check(test), test.name);
  return Evaluation(test, {}).decompose();
}

BallBarEvaluation evaluate_ball_bar(const BallBarTest& test, const BallBarSettings& settings) {
  require(check(test), test.name);
  return Evaluation(test, settings).run();
}

}  // namespace volcomp::host
