#include "host_sim/host/measure/identify/planned_places.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comp/core/units.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/found_values.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"

namespace volcomp::host::identify {
namespace {

class Planner {
 public:
  Planner(const MeasurementPlan& plan, const PlaceChoice& choice, SetUp& setup)
      : plan_(plan),
        problem_(plan.problem),
        chain_(plan.problem.machine.chain),
        choice_(choice),
        setup_(setup) {}

  // The whole way with one tip after the other: a tip that comes back in turn would go in step with
  // the directions of the axes, and reversal could not be told from where it is.
  void add() {
    if (choice_.tips.empty()) add_way();
    for (const std::size_t tip : choice_.tips) {
      tip_ = tip;
      add_way();
    }
    if (setup_.q.empty())
      throw UserError(
          fmt::format("{}: nothing of set-up \"{}\" is within reach", plan_.path, setup_.name));
  }

 private:
  void add_way() {
    switch (setup_.kind) {
      case ObservationKind::tracer:
        add_tracer();
        break;
      case ObservationKind::bar:
        add_circle();
        break;
      case ObservationKind::diagonal:
        add_diagonal();
        break;
      case ObservationKind::step:
        add_steps();
        break;
      case ObservationKind::rtest:
        add_turns();
        break;
      default:
        add_targets();
        break;
    }
  }

  void stand(const Pose& q) {
    Directions d = setup_.d.empty() ? first_directions() : setup_.d.back();
    if (!setup_.q.empty()) arrive_at(setup_.q.back(), q, d);
    if (tip_) setup_.stylus.push_back(*tip_);
    setup_.q.push_back(q);
    setup_.d.push_back(d);
  }

  [[nodiscard]] Directions first_directions() const {
    Directions d{};
    for (std::size_t a = 0; a < chain_.axis_count(); ++a)
      d.at(a) = 1.0;
    return d;
  }

  [[nodiscard]] Vec3 tip() const {
    const auto stylus = tip_ ? tip_ : problem_.reference();
    return stylus ? problem_.styli[*stylus].offset : chain_.tool_point();
  }

  [[nodiscard]] Pose reference_pose() const {
    Pose q{};
    for (std::size_t a = 0; a < chain_.axis_count(); ++a)
      q.at(a) = problem_.machine.travel.at(a).reference;
    return q;
  }

  // With the ideal tip at a place of the work frame, where the travels allow it.
  void stand_at(const Vec3& place, Pose q) {
    const ChainGeometry g = ideal_geometry(chain_, q);
    if (!move_by(chain_, g, place - g.in_work(tip()), q)) return;
    for (std::size_t a = 0; a < chain_.axis_count(); ++a) {
      const Travel& travel = problem_.machine.travel.at(a);
      if (q.at(a) < travel.lo || q.at(a) > travel.hi) return;
    }
    stand(q);
  }

  // Other places at every station and with every tip: the next ones of one sequence.
  void add_tracer() {
    constexpr double kClear_mm = 60.0;
    const std::size_t all = choice_.count == 0 ? kTracerPlaces : choice_.count;
    const std::size_t tips = std::max<std::size_t>(1, choice_.tips.size());
    const std::size_t begin = all * problem_.setups.size() + read_;
    const std::vector<Pose> places =
        places_of(problem_.machine, begin + (all - read_) / (tips - tips_done_));
    for (std::size_t i = begin; i < places.size(); ++i) {
      ++read_;
      const Vec3 p = ideal_geometry(chain_, places[i]).in_work(tip());
      if ((p - *setup_.station).norm() > kClear_mm) stand(places[i]);
    }
    ++tips_done_;
  }

  // Round and back again.
  void add_circle() {
    constexpr int kPlaces = 72;
    const std::array<Vec3, 2> e = across(setup_.normal);
    for (const int sense : {1, -1}) {
      for (int i = 0; i <= kPlaces; ++i) {
        const double angle = sense * 2.0 * kPi * i / kPlaces;
        stand_at(
            *setup_.station + setup_.length * (std::cos(angle) * e[0] + std::sin(angle) * e[1]),
            reference_pose());
      }
    }
  }

  // Linear axes, and at which end of its travel each begins when the tip goes along the beam.
  struct Corner {
    std::size_t axis = 0;
    double from = 0.0;
    double to = 0.0;
  };
  [[nodiscard]] std::vector<Corner> corners() const {
    std::vector<Corner> out;
    const ChainGeometry g = ideal_geometry(chain_, reference_pose());
    for (std::size_t a = 0; a < chain_.axis_count(); ++a) {
      if (!problem_.is_slide(a)) continue;
      const Travel& travel = problem_.machine.travel.at(a);
      const bool up = slide_in_work(chain_, g, a).dot(*setup_.along) >= 0.0;
      out.push_back({a, up ? travel.lo : travel.hi, up ? travel.hi : travel.lo});
    }
    return out;
  }

  // Along the beam through the middle of the travels, from end to end, there and back.
  void add_diagonal() {
    constexpr int kPlaces = 20;
    Pose middle = reference_pose();
    for (std::size_t a = 0; a < chain_.axis_count(); ++a)
      if (problem_.is_slide(a))
        middle.at(a) = 0.5 * (problem_.machine.travel.at(a).lo + problem_.machine.travel.at(a).hi);
    Pose ahead = middle;
    if (!move_by(chain_, ideal_geometry(chain_, middle), *setup_.along, ahead)) return;
    double half = HUGE_VAL;
    for (std::size_t a = 0; a < chain_.axis_count(); ++a) {
      const Travel& travel = problem_.machine.travel.at(a);
      const double step = std::abs(ahead.at(a) - middle.at(a));
      if (step > 0.0) half = std::min(half, 0.5 * (travel.hi - travel.lo) / step);
    }
    for (int i = 0; i <= 2 * kPlaces; ++i) {
      const int place = i <= kPlaces ? i : 2 * kPlaces - i;
      const double along = half * (2.0 * place / kPlaces - 1.0);
      Pose q = middle;
      for (std::size_t a = 0; a < chain_.axis_count(); ++a)
        q.at(a) = std::clamp(middle.at(a) + along * (ahead.at(a) - middle.at(a)),
                             problem_.machine.travel.at(a).lo, problem_.machine.travel.at(a).hi);
      stand(q);
    }
  }

  // One axis after the other.
  void add_steps() {
    constexpr int kSteps = 8;
    Pose q = reference_pose();
    const std::vector<Corner> all = corners();
    for (const Corner& c : all)
      q.at(c.axis) = c.from;
    stand(q);
    for (int i = 1; i <= kSteps; ++i) {
      for (const Corner& c : all) {
        q.at(c.axis) = c.from + (c.to - c.from) * i / kSteps;
        stand(q);
      }
    }
  }

  [[nodiscard]] std::vector<double> turns_of(std::size_t axis) const {
    constexpr int kOfTurn = 12;
    constexpr int kOther = 5;
    if (!choice_.turn.at(axis).empty()) return choice_.turn.at(axis);
    const Travel& travel = problem_.machine.travel.at(axis);
    const int count = travel.periodic ? kOfTurn : kOther;
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      out.push_back(travel.lo +
                    (travel.hi - travel.lo) * i / (travel.periodic ? count : count - 1));
    return out;
  }

  void add_turns() {
    if (!choice_.ball)
      throw UserError(fmt::format("{}: set-up \"{}\" has neither readings nor ball_mm", plan_.path,
                                  setup_.name));
    std::vector<Pose> poses{reference_pose()};
    for (std::size_t a = 0; a < chain_.axis_count(); ++a) {
      if (problem_.is_slide(a)) continue;
      std::vector<Pose> more;
      for (const Pose& pose : poses)
        for (const double angle : turns_of(a)) {
          more.push_back(pose);
          more.back().at(a) = angle;
        }
      poses = std::move(more);
    }
    for (const Pose& q : poses)
      stand_at(*choice_.ball, q);
  }

  // Runs: up and down five times.
  void add_targets() {
    constexpr int kRuns = 5;
    const std::vector<double> targets = plan_.machine.axes[setup_.axis].all_targets();
    for (int run = 0; run < 2 * kRuns; ++run) {
      for (std::size_t i = 0; i < targets.size(); ++i) {
        Pose q{};
        q.at(setup_.axis) = targets[run % 2 == 0 ? i : targets.size() - 1 - i];
        Directions d{};
        d.at(setup_.axis) = run % 2 == 0 ? 1.0 : -1.0;
        setup_.q.push_back(q);
        setup_.d.push_back(d);
      }
    }
  }

  const MeasurementPlan& plan_;
  const Problem& problem_;
  const MachineChain& chain_;
  const PlaceChoice& choice_;
  SetUp& setup_;
  std::optional<std::size_t> tip_;  // none: the reference stylus
  std::size_t read_ = 0;            // places of a tracer so far
  std::size_t tips_done_ = 0;
};

}  // namespace

void add_planned_places(const MeasurementPlan& plan, const PlaceChoice& choice, SetUp& setup) {
  Planner(plan, choice, setup).add();
}

}  // namespace volcomp::host::identify
