#include "host_sim/host/measure/identify/plan_readings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "comp/machine/error_motion.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/observation_table.hpp"
#include "host_sim/host/measure/identify/plan_values.hpp"
#include "host_sim/host/measure/identify/planned_places.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"
#include "host_sim/host/measure/identify/touched_spheres.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host::identify {
namespace {

class ReadingsReader {
 public:
  ReadingsReader(MeasurementPlan& plan, const SetUpFiles& files, const TomlSection& s, SetUp& setup)
      : plan_(plan), problem_(plan.problem), files_(files), s_(s), setup_(setup) {}

  void read() {
    plan_.touched.emplace_back();
    plan_.file_of.push_back(s_.has("file") ? file_name() : "");
    plan_.touch_sigma.push_back(0.0);
    if (setup_.has_pose()) {
      read_touched();
    } else if (setup_.kind == ObservationKind::runs) {
      read_runs_of_axis();
    } else {
      read_table();
    }
  }

 private:
  std::string file_name() const {
    std::string name = s_.text("file");
    if (name.empty() || name == "-" || std::any_of(name.begin(), name.end(), [](char c) {
          return static_cast<unsigned char>(c) < 0x20;
        }))
      s_.complain("file", "'file' must name a file");
    return name;
  }

  // Its file for `read(stream, name)`; false where there is none and none is needed.
  template <class Read>
  bool with_file(const Read& read) {
    const std::string& name = plan_.file_of.back();
    if (const auto given = files_.given.text.find(name); given != files_.given.text.end()) {
      std::istringstream stream(given->second);
      read(stream, name);
      return true;
    }
    const std::filesystem::path path = files_.folder / name;
    std::error_code error;
    if (files_.given.may_lack && (name.empty() || !std::filesystem::exists(path, error))) {
      plan_.lacking.push_back(setup_.name);
      return false;
    }
    if (name.empty()) static_cast<void>(s_.text("file"));  // complains
    plan_.files.push_back(path);
    InputFile file(path);
    read(file.stream(), file.name());
    return true;
  }

  double not_negative(const std::string& key) const {
    const double value = s_.number_or(key, 0.0);
    if (value < 0.0) s_.complain(key, fmt::format("'{}' must not be negative", key));
    return value;
  }
  double machine_mm() const { return kMmPerUm * not_negative("machine_um"); }

  void read_table() {
    const auto take = [&](std::istream& stream, const std::string& name) {
      take_rows(read_observation_table(stream, name, plan_.machine, setup_.kind));
    };
    if (!with_file(take)) add_planned_places(plan_, place_choice(), setup_);
    setup_.sigma.assign(setup_.q.size() * setup_.components(),
                        std::hypot(kMmPerUm * positive(s_, "u_um"), machine_mm()));
  }

  void take_rows(const ObservationTable& table) {
    for (const TableRow& row : table.rows) {
      setup_.q.push_back(row.q);
      setup_.d.push_back(row.d);
      if (!row.tip.empty()) setup_.stylus.push_back(stylus_of(row, table.name));
      if (table.has_readings) setup_.y.insert(setup_.y.end(), row.value.begin(), row.value.end());
    }
  }

  PlaceChoice place_choice() const {
    constexpr long kMostPlaces = 10'000;
    PlaceChoice choice;
    if (s_.has("places"))
      choice.count = static_cast<std::size_t>(s_.integer("places", 1, kMostPlaces));
    if (s_.has("tips")) choice.tips = tips_named("tips");
    choice.turn = turns();
    if (s_.has("ball_mm")) choice.ball = vector_of(s_, "ball_mm");
    return choice;
  }

  // "{ A = [-80, 0], C = [0, 90] }", degrees.
  std::array<std::vector<double>, kMaxAxes> turns() const {
    std::array<std::vector<double>, kMaxAxes> out;
    if (!s_.has("turns_deg")) return out;
    const TomlValue& table = s_.need("turns_deg");
    if (!table.is_table()) s_.complain("turns_deg", "'turns_deg' must be { A = [0, 45], … }");
    const TomlSection turns = s_.table("turns_deg");
    for (const auto& [name, list] : table.table()) {
      const std::size_t a = axis_named(plan_, s_, "turns_deg", name);
      if (problem_.is_slide(a))
        s_.complain("turns_deg", fmt::format("'turns_deg': {} is a linear axis", name));
      if (!list.is_array() || list.array().empty())
        s_.complain("turns_deg", fmt::format("'turns_deg': {} must be a list of angles", name));
      const Travel& travel = problem_.machine.travel.at(a);
      for (const double degrees : turns.numbers(name, list.array().size())) {
        const double angle = kRadPerDegree * degrees;
        if (angle < travel.lo || angle > travel.hi)
          s_.complain("turns_deg",
                      fmt::format("'turns_deg': {} does not turn to {:g} degrees", name, degrees));
        out.at(a).push_back(angle);
      }
    }
    return out;
  }

  std::size_t stylus_of(const TableRow& row, const std::string& name) const {
    for (std::size_t i = 0; i < problem_.styli.size(); ++i)
      if (problem_.styli[i].name == row.tip) return i;
    throw UserError(fmt::format("{}:{}: the plan has no stylus \"{}\" [{}]", name, row.line,
                                row.tip, code(Reason::unknown_reference)));
  }

  // Runs of one axis as for build-tables: relative values become those of the body.
  void read_runs_of_axis() {
    const auto take = [&](std::istream& stream, const std::string& name) {
      take_runs(read_runs(stream, name));
    };
    if (!with_file(take)) add_planned_places(plan_, {}, setup_);
    const double mm = std::hypot(kMmPerUm * positive(s_, "u_um"), machine_mm());
    const double rad =
        kRadPerUrad * std::hypot(positive(s_, "u_urad"), not_negative("machine_urad"));
    for (std::size_t i = 0; i < setup_.q.size(); ++i)
      setup_.sigma.insert(setup_.sigma.end(), {mm, mm, mm, rad, rad, rad});
  }

  void take_runs(const RunsFile& runs) {
    const AxisFile& axis = plan_.machine.axes[setup_.axis];
    if (runs.letter != axis.letter)
      throw UserError(fmt::format("{}: holds runs of axis {}, the set-up is of {}", runs.name,
                                  runs.letter, axis.letter));
    const Joint& joint = plan_.machine.chain.axis(setup_.axis);
    const auto add = [&](const std::vector<RunValues>& passes, double direction) {
      for (const RunValues& values : passes) {
        for (std::size_t t = 0; t < values.size(); ++t) {
          Pose q{};
          Directions d{};
          q.at(setup_.axis) = runs.positions[t];
          d.at(setup_.axis) = direction;
          setup_.q.push_back(q);
          setup_.d.push_back(d);
          const ErrorMotion y = to_internal(values[t], joint, runs.positions[t],
                                            plan_.machine.convention, plan_.machine.side);
          setup_.y.insert(setup_.y.end(), y.data(), y.data() + y.size());
        }
      }
    };
    add(runs.up, 1.0);
    add(runs.down, -1.0);
  }

  void read_touched() {
    const double sigma = std::hypot(kMmPerUm * positive(s_, "probe_um"), machine_mm());
    plan_.touch_sigma.back() = sigma;
    const auto take = [&](std::istream& stream, const std::string& name) {
      add_touches(read_observation_table(stream, name, plan_.machine, setup_.kind), sigma);
    };
    if (setup_.kind == ObservationKind::touch && !files_.given.may_lack)
      static_cast<void>(s_.text("file"));  // complains
    if (plan_.file_of.back().empty() || !with_file(take))
      add_planned_spheres(plan_, sphere_choice(), sigma, setup_);
  }

  SphereChoice sphere_choice() const {
    constexpr long kMostPositions = 10'000;
    SphereChoice choice;
    choice.tips = named_tips();
    if (s_.has("more_tips")) choice.more_tips = tips_named("more_tips");
    if (s_.has("more_tips_every"))
      choice.more_every =
          static_cast<std::size_t>(s_.integer("more_tips_every", 1, kMostPositions));
    choice.turn = turns();
    return choice;
  }

  // Indices of the styli that the set-up names; none named: all.
  std::vector<std::size_t> named_tips() const {
    if (s_.has("tips")) return tips_named("tips");
    std::vector<std::size_t> tips;
    for (std::size_t i = 0; i < problem_.styli.size(); ++i)
      tips.push_back(i);
    return tips;
  }

  std::vector<std::size_t> tips_named(const std::string& key) const {
    std::vector<std::size_t> tips;
    for (const std::string& name : words_of(s_, key, s_.need(key)))
      tips.push_back(index_named(problem_.styli, name, s_, key));
    return tips;
  }

  void add_touches(const ObservationTable& table, double sigma) {
    std::vector<TipTouch> touches;
    for (const TableRow& row : table.rows) {
      if (row.setup != setup_.name) continue;
      if (row.sphere >= problem_.artefacts[*setup_.artefact].spheres.size())
        throw UserError(fmt::format("{}:{}: artefact \"{}\" has no sphere {} [{}]", table.name,
                                    row.line, problem_.artefacts[*setup_.artefact].name, row.sphere,
                                    code(Reason::unknown_reference)));
      const std::size_t stylus =
          row.tip.empty() ? problem_.reference().value_or(0) : stylus_of(row, table.name);
      touches.push_back({row.line, row.sphere, stylus, row.q, row.d});
    }
    if (touches.empty())
      throw UserError(
          fmt::format("{}: there is no touch of set-up \"{}\"", table.name, setup_.name));
    if (setup_.kind == ObservationKind::touch) {
      add_single_touches(touches, sigma, setup_);
    } else {
      add_centres(plan_, table.name, touches, sigma, setup_);
    }
  }

  MeasurementPlan& plan_;
  Problem& problem_;
  const SetUpFiles& files_;
  const TomlSection& s_;
  SetUp& setup_;
};

}  // namespace

void read_readings(MeasurementPlan& plan, const SetUpFiles& files, const TomlSection& s,
                   SetUp& setup) {
  ReadingsReader(plan, files, s, setup).read();
}

std::size_t axis_named(const MeasurementPlan& plan, const TomlSection& s, const std::string& key,
                       const std::string& name) {
  for (std::size_t a = 0; a < plan.machine.axes.size(); ++a)
    if (name == std::string(1, plan.machine.axes[a].letter)) return a;
  s.complain(key, fmt::format("'{}': the machine has no axis {} [{}]", key, name,
                              code(Reason::unknown_reference)));
}

}  // namespace volcomp::host::identify
