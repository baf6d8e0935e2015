#include "host_sim/sim/campaign/simulated_readings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/instruments/bidirectional_runs.hpp"
#include "host_sim/sim/instruments/drift.hpp"

namespace volcomp::sim {
namespace {

using namespace host::identify;

double noise(const PlanTruth& truth, RandomStream stream, std::size_t setup, std::uint32_t reading,
             double sigma) {
  if (truth.floor.perfect) return 0.0;
  return sigma * normal(truth.floor.seed, {static_cast<std::uint32_t>(stream), truth.floor.draw,
                                           static_cast<std::uint32_t>(setup), reading});
}

// The machine as a station on the bed sees it: without what the axes of the work do wrong.
TrueMachine seen_from_bed(TrueMachine machine) {
  for (std::size_t a = 0; a < machine.chain.axis_count(); ++a) {
    if (machine.chain.axis(a).branch != Branch::work) continue;
    TrueAxis right;
    right.lo = machine.axis[a].lo;
    right.hi = machine.axis[a].hi;
    machine.axis[a] = right;
    machine.warmer_K.at(a) = -machine.temperature_offset_K;
    machine.directions[a] = zero_directions()[a];
  }
  return machine;
}

// An instrument beside the true machine of one set-up.
class Instrument {
 public:
  Instrument(const MeasurementPlan& plan, const PlanTruth& truth, std::size_t setup)
      : problem_(plan.problem),
        chain_(problem_.machine.chain),
        s_(problem_.setups[setup]),
        truth_(truth),
        t_(truth.setup[setup]),
        machine_(s_.in_bed ? seen_from_bed(t_.machine) : t_.machine) {
    // Whoever puts the ball of an R-test there brings the nest to it first.
    if (s_.kind == ObservationKind::rtest)
      ball_ = ideal_geometry(chain_, s_.q.front()).in_work(problem_.tip_of(s_, 0)) + t_.station;
  }

  // Components of an observation, without noise.
  [[nodiscard]] std::vector<double> at(std::size_t i) const {
    const Vec3 p = point(i);
    const double longer = 1.0 + t_.kappa;
    switch (s_.kind) {
      case ObservationKind::tracer:
        return {longer * (seen(i, p) - t_.station).norm() + t_.dead_length};
      case ObservationKind::bar:
        return {longer * (p - t_.station).norm() - s_.length + t_.dead_length};
      case ObservationKind::diagonal:
        return {longer * s_.along->dot(p) + t_.dead_length};
      case ObservationKind::step: {
        const Vec3 m = turned(i) * t_.mirror;
        return {longer * m.dot(p - *s_.beam) / m.dot(*s_.along) + t_.dead_length};
      }
      default: {
        const Vec3 off = turned(i).transpose() * (ball_ - p);
        return {off.x(), off.y(), off.z()};
      }
    }
  }

 private:
  [[nodiscard]] Vec3 tip(std::size_t i) const {
    const auto stylus = problem_.stylus_of(s_, i);
    return stylus ? truth_.tip[*stylus] : chain_.tool_point();
  }
  [[nodiscard]] Vec3 point(std::size_t i) const {
    return true_point(machine_, s_.q[i], s_.d[i], tip(i));
  }
  // In the frame of the station.
  [[nodiscard]] Vec3 seen(std::size_t i, const Vec3& p) const {
    return s_.in_bed ? ideal_geometry(chain_, s_.q[i]).work.apply(p) : p;
  }
  // Orientation of the tool in the work frame.
  [[nodiscard]] Mat3 turned(std::size_t i) const {
    const Vec3 turn = machine_.error(s_.q[i], s_.d[i], tip(i)).orientation_work;
    return exponential(turn) * ideal_geometry(chain_, s_.q[i]).tool_in_work();
  }

  const Problem& problem_;
  const MachineChain& chain_;
  const SetUp& s_;
  const PlanTruth& truth_;
  const TrueSetUp& t_;
  TrueMachine machine_;
  Vec3 ball_ = Vec3::Zero();
};

RandomStream stream_of(ObservationKind kind) {
  switch (kind) {
    case ObservationKind::tracer:
      return RandomStream::tracker;
    case ObservationKind::bar:
      return RandomStream::ball_bar;
    case ObservationKind::rtest:
      return RandomStream::r_test;
    default:
      return RandomStream::laser;
  }
}

// What a tracer has drifted by each reading of a set-up, mm; others do not drift.
std::vector<double> drift_of(const PlanTruth& truth, std::size_t setup, const SetUp& s) {
  const std::size_t count = s.q.size();
  if (s.kind != ObservationKind::tracer || truth.floor.perfect) return std::vector<double>(count);
  constexpr double kHour_s = 3600.0;
  const Drift walk{DriftKind::walk, truth.floor.drift_mm / std::sqrt(kHour_s), 1.0};
  std::vector<double> time(count);
  std::vector<double> z(count);
  for (std::size_t i = 0; i < count; ++i) {
    time[i] = truth.floor.dwell_s * static_cast<double>(i);
    z[i] = noise(truth, RandomStream::drift, setup, static_cast<std::uint32_t>(i), 1.0);
  }
  return walk.at(time, z);
}

}  // namespace

Vec3 true_point(const TrueMachine& machine, const Pose& q, const Directions& d, const Vec3& tip) {
  return ideal_points(machine.chain, q, tip).work + machine.error(q, d, tip).position_work;
}

double scatter_of_touch(const MeasurementPlan& plan, const PlanTruth& truth, std::size_t setup,
                        std::uint32_t touch) {
  return noise(truth, RandomStream::probe, setup, touch, plan.touch_sigma[setup]);
}

LatchedTouch touch_sphere(const MeasurementPlan& plan, const PlanTruth& truth,
                          const TouchMove& move, double scatter_mm, Directions& d) {
  arrive_at(move.from, move.beyond, d);
  const TrueSetUp& t = truth.setup[move.setup];
  const std::size_t artefact = *plan.problem.setups[move.setup].artefact;
  const Vec3 centre = t.pose.R * truth.sphere[artefact][move.sphere] + t.pose.t;
  const double contact = plan.problem.artefacts[artefact].radius[move.sphere] +
                         truth.tip_radius[move.stylus] + scatter_mm;
  LatchedTouch latched{move.setup, move.sphere, move.stylus, move.from, d};
  const auto gap_at = [&](double part) {
    for (std::size_t a = 0; a < kMaxAxes; ++a)
      latched.q.at(a) = move.from.at(a) + part * (move.beyond.at(a) - move.from.at(a));
    return (true_point(t.machine, latched.q, d, truth.tip[move.stylus]) - centre).norm() - contact;
  };
  // Secant: the gap closes evenly.
  double before = 0.0;
  double gap_before = gap_at(before);
  double part = kClearance_mm / (kClearance_mm + kOvertravel_mm);
  constexpr int kSteps = 6;
  constexpr double kClosed_mm = 1e-9;
  double gap = gap_at(part);
  for (int i = 0; i < kSteps && std::abs(gap) > kClosed_mm; ++i) {
    const double next = part - gap * (part - before) / (gap - gap_before);
    before = part;
    gap_before = gap;
    part = next;
    gap = gap_at(part);
  }
  if (!(part > 0.0 && part < 1.0) || !(std::abs(gap) <= 1e3 * kClosed_mm))
    throw host::UserError(fmt::format("set-up \"{}\": sphere {} was not touched",
                                      plan.problem.setups[move.setup].name, move.sphere));
  return latched;
}

std::vector<LatchedTouch> touch_all(const MeasurementPlan& plan, const PlanTruth& truth) {
  std::vector<LatchedTouch> touches;
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
    if (!plan.problem.setups[k].has_pose()) continue;
    Directions d{};
    std::uint32_t number = 0;
    const Pose* last = nullptr;
    const std::vector<TouchMove> moves = touch_moves(plan, k);
    for (const TouchMove& move : moves) {
      if (last != nullptr) arrive_at(*last, move.from, d);
      touches.push_back(
          touch_sphere(plan, truth, move, scatter_of_touch(plan, truth, k, number++), d));
      // Back the way it came.
      arrive_at(move.beyond, move.from, d);
      last = &move.from;
    }
  }
  return touches;
}

void read_instrument(const MeasurementPlan& plan, const PlanTruth& truth, std::size_t setup,
                     SetUp& out) {
  const Instrument instrument(plan, truth, setup);
  const std::vector<double> drift = drift_of(truth, setup, out);
  out.y.clear();
  for (std::size_t i = 0; i < out.q.size(); ++i) {
    for (const double y : instrument.at(i)) {
      const auto number = static_cast<std::uint32_t>(out.y.size());
      out.y.push_back(y + drift[i] +
                      noise(truth, stream_of(out.kind), setup, number, out.sigma[out.y.size()]));
    }
  }
}

host::RunsFile read_axis(const MeasurementPlan& plan, const PlanTruth& truth, std::size_t setup) {
  const SetUp& s = plan.problem.setups[setup];
  const TrueSetUp& t = truth.setup[setup];
  const host::AxisFile& axis = plan.machine.axes[s.axis];
  const auto along = plan.machine.chain.axis(s.axis).axis;
  std::uint32_t number = 0;
  constexpr std::size_t kRuns = 5;
  return bidirectional_runs(axis.letter, axis.all_targets(), kRuns, [&](const Stop& stop) {
    Pose pose{};
    pose[s.axis] = stop.q;
    Approach from{};
    from[s.axis] = stop.approach;
    ErrorMotion seen =
        at_lever(in_file_terms(t.machine.errors(pose, from)[s.axis], plan.machine, s.axis, stop.q),
                 axis.sensed.lever(along, stop.q)) +
        t.zero;
    for (Eigen::Index c = 0; c < 6; ++c)
      seen(c) +=
          noise(truth, RandomStream::laser, setup, number++, s.sigma[static_cast<std::size_t>(c)]);
    return seen;
  });
}

std::map<std::string, std::string> files_of_plan(const MeasurementPlan& plan,
                                                 const PlanTruth& truth,
                                                 const std::vector<LatchedTouch>& touches) {
  std::map<std::string, std::string> files;
  std::map<std::string, std::vector<LatchedTouch>> touched;
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
    const std::string& name = plan.file_of[k];
    SetUp s = plan.problem.setups[k];
    if (name.empty())
      throw host::UserError(
          fmt::format("{}: set-up \"{}\" names no file for its readings", plan.path, s.name));
    if (const std::filesystem::path path = name;
        path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
      throw host::UserError(
          fmt::format("{}: \"{}\" lies outside the folder of the readings", plan.path, name));
    if (s.has_pose()) {
      for (const LatchedTouch& touch : touches)
        if (touch.setup == k) touched[name].push_back(touch);
      continue;
    }
    if (files.count(name) != 0)
      throw host::UserError(fmt::format("{}: \"{}\" is the file of two set-ups", plan.path, name));
    if (s.kind == ObservationKind::runs) {
      files[name] = host::runs_csv(read_axis(plan, truth, k));
    } else {
      read_instrument(plan, truth, k, s);
      if (!std::all_of(s.y.begin(), s.y.end(), [](double y) { return std::isfinite(y); }))
        throw host::UserError(
            fmt::format("{}: set-up \"{}\" has a reading that is not finite", plan.path, s.name));
      files[name] = readings_csv(plan, s);
    }
  }
  for (const auto& [name, list] : touched) {
    if (!files.emplace(name, touches_csv(plan, list)).second)
      throw host::UserError(
          fmt::format("{}: \"{}\" is the file of touches and of others", plan.path, name));
  }
  for (auto& [name, text] : files)
    text.insert(0, fmt::format("# Simulated: no machine was measured. Seed of the readings {}.\n",
                               truth.floor.seed));
  return files;
}

std::map<std::string, std::string> simulate_plan(const MeasurementPlan& plan,
                                                 const PlanTruth& truth) {
  return files_of_plan(plan, truth, touch_all(plan, truth));
}

}  // namespace volcomp::sim
