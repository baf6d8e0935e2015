#include "host_sim/host/measure/identify/plan_setup.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "comp/machine/error_motion.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/observation_table.hpp"
#include "host_sim/host/measure/identify/plan_values.hpp"
#include "host_sim/host/measure/identify/touched_spheres.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::host::identify {
namespace {

template <class Named>
std::size_t index_of(const std::vector<Named>& list, const std::string& name, const TomlSection& s,
                     const std::string& key) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return i;
  s.complain(key, fmt::format("'{}': there is no \"{}\" [{}]", key, name,
                              code(Reason::unknown_reference)));
}

class SetUpReader {
 public:
  SetUpReader(MeasurementPlan& plan, std::filesystem::path folder, const TomlSection& s)
      : plan_(plan), problem_(plan.problem), folder_(std::move(folder)), s_(s) {}

  void read() {
    setup_.name = s_.text("name");
    setup_.kind =
        static_cast<ObservationKind>(s_.choice("kind", {kKindNames.begin(), kKindNames.end()}));
    if (s_.has("scale_ppm")) setup_.scale = prior_of(s_, "scale_ppm", kPpm);
    read_fields();
    plan_.touched.emplace_back();
    if (setup_.has_pose()) {
      read_touched();
    } else if (setup_.kind == ObservationKind::runs) {
      read_runs_of_axis();
    } else {
      read_table();
    }
    problem_.setups.push_back(std::move(setup_));
  }

 private:
  using Kind = ObservationKind;

  void allow(std::vector<std::string> own) {
    const std::vector<std::string> all{"name", "kind", "file", "scale_ppm", "machine_um"};
    own.insert(own.end(), all.begin(), all.end());
    s_.allow_only(own);
  }

  void read_fields() {
    switch (setup_.kind) {
      case Kind::tracer:
        allow({"u_um", "station_mm", "frame"});
        setup_.station = vector_of(s_, "station_mm");
        setup_.in_bed = s_.has("frame") && s_.choice("frame", {"work", "bed"}) == 1;
        break;
      case Kind::bar:
        read_bar();
        break;
      case Kind::diagonal:
        allow({"u_um", "along"});
        setup_.along = beam_direction();
        break;
      case Kind::step:
        allow({"u_um", "along", "beam_mm", "mirror"});
        setup_.along = beam_direction();
        setup_.beam = vector_of(s_, "beam_mm");
        setup_.mirror = s_.has("mirror") ? unit_of(s_, "mirror") : *setup_.along;
        break;
      case Kind::rtest:
        allow({"u_um"});
        break;
      case Kind::runs:
        allow({"u_um", "u_urad", "machine_urad", "axis", "slopes"});
        break;
      case Kind::centre:
      case Kind::touch:
        allow({"probe_um", "artefact", "tips", "pose_deg_mm"});
        setup_.artefact = index_of(problem_.artefacts, s_.text("artefact"), s_, "artefact");
        read_pose();
        break;
    }
  }

  // "PPP", signs of X Y Z along a body diagonal of the travels, or a vector in the work frame.
  Vec3 beam_direction() const {
    const toml::value& v = s_.need("along");
    if (!v.is_string()) return unit_of(s_, "along");
    const std::string& word = v.as_string().str;
    Vec3 u;
    for (std::size_t k = 0; k < 3; ++k) {
      const char sign = word.size() == 3 ? word[k] : '?';
      if (sign != 'P' && sign != 'N')
        s_.complain("along", "'along' must be three of P and N for X Y Z, or [x, y, z]");
      const AxisFile& axis = plan_.machine.axes[plan_.machine.axis_index("XYZ"[k])];
      u(static_cast<Eigen::Index>(k)) = (sign == 'P' ? 1.0 : -1.0) * (axis.hi - axis.lo);
    }
    return u.normalized();
  }

  void read_bar() {
    allow({"u_um", "socket_mm", "length_mm", "length_u_um", "plane"});
    setup_.station = vector_of(s_, "socket_mm");
    setup_.length = positive(s_, "length_mm");
    setup_.length_prior = s_.has("length_u_um") ? kMmPerUm * positive(s_, "length_u_um") : kFree;
    const toml::value& plane = s_.need("plane");
    if (!plane.is_string()) {
      setup_.normal = unit_of(s_, "plane");
      return;
    }
    const std::array<const char*, 3> names{"YZ", "ZX", "XY"};
    const auto* const found = std::find(names.begin(), names.end(), plane.as_string().str);
    if (found == names.end())
      s_.complain("plane", R"('plane' must be "XY", "YZ", "ZX" or the normal [x, y, z])");
    setup_.normal = Vec3::Unit(found - names.begin());
  }

  void read_pose() {
    if (!s_.has("pose_deg_mm")) return;
    const auto p = s_.numbers<6>("pose_deg_mm");
    setup_.pose =
        Placement{exponential(kRadPerDegree * Vec3(p[0], p[1], p[2])), {p[3], p[4], p[5]}};
  }

  std::filesystem::path file() {
    plan_.files.push_back(folder_ / s_.text("file"));
    return plan_.files.back();
  }

  double machine_mm() const {
    const double um = s_.number_or("machine_um", 0.0);
    if (um < 0.0) s_.complain("machine_um", "'machine_um' must not be negative");
    return kMmPerUm * um;
  }

  void read_table() {
    const ObservationTable table = read_observation_table(file(), plan_.machine, setup_.kind);
    const double sigma = std::hypot(kMmPerUm * positive(s_, "u_um"), machine_mm());
    for (const TableRow& row : table.rows) {
      setup_.q.push_back(row.q);
      setup_.d.push_back(row.d);
      if (!row.tip.empty()) setup_.stylus.push_back(stylus_of(row, table.name));
      if (table.has_readings) setup_.y.insert(setup_.y.end(), row.value.begin(), row.value.end());
    }
    setup_.sigma.assign(setup_.q.size() * setup_.components(), sigma);
  }

  std::size_t stylus_of(const TableRow& row, const std::string& name) const {
    for (std::size_t i = 0; i < problem_.styli.size(); ++i)
      if (problem_.styli[i].name == row.tip) return i;
    throw UserError(fmt::format("{}:{}: the plan has no stylus \"{}\" [{}]", name, row.line,
                                row.tip, code(Reason::unknown_reference)));
  }

  // Runs of one axis as for build-tables: relative values become those of the body.
  void read_runs_of_axis() {
    const RunsFile runs = read_runs_file(file());
    setup_.axis = plan_.machine.axis_index(s_.text("axis").at(0));
    const AxisFile& axis = plan_.machine.axes[setup_.axis];
    if (runs.letter != axis.letter)
      throw UserError(fmt::format("{}: holds runs of axis {}, the set-up is of {}", runs.name,
                                  runs.letter, axis.letter));
    setup_.channels = {0, 1, 2, 3, 4, 5};
    setup_.lever = axis.sensed.at_zero;
    setup_.kappa = axis.sensed.kappa;
    setup_.slopes = s_.truth_or("slopes", true);
    const double mm = std::hypot(kMmPerUm * positive(s_, "u_um"), machine_mm());
    const double rad =
        kRadPerUrad * std::hypot(positive(s_, "u_urad"), s_.number_or("machine_urad", 0.0));
    const Joint& joint = plan_.machine.chain.axis(setup_.axis);
    const auto add = [&](const std::vector<RunValues>& passes, double direction) {
      for (const RunValues& values : passes)
        for (std::size_t t = 0; t < values.size(); ++t) {
          Pose q{};
          Directions d{};
          q.at(setup_.axis) = runs.positions[t];
          d.at(setup_.axis) = direction;
          setup_.q.push_back(q);
          setup_.d.push_back(d);
          const ErrorMotion y = to_internal(values[t], joint, runs.positions[t],
                                            plan_.machine.convention, plan_.machine.side);
          for (Eigen::Index c = 0; c < 6; ++c) {
            setup_.y.push_back(y(c));
            setup_.sigma.push_back(c < 3 ? mm : rad);
          }
        }
    };
    add(runs.up, 1.0);
    add(runs.down, -1.0);
  }

  void read_touched() {
    const double sigma = std::hypot(kMmPerUm * positive(s_, "probe_um"), machine_mm());
    if (s_.has("file")) {
      const ObservationTable table = read_observation_table(file(), plan_.machine, setup_.kind);
      add_touches(table, sigma);
    } else if (setup_.kind == Kind::touch) {
      s_.complain("kind", "single touches can only be planned with a file of their positions");
    } else {
      add_planned_spheres(plan_, named_tips(), sigma, setup_);
    }
  }

  // Indices of the styli that the set-up names; none named: all.
  std::vector<std::size_t> named_tips() const {
    std::vector<std::size_t> tips;
    if (!s_.has("tips")) {
      for (std::size_t i = 0; i < problem_.styli.size(); ++i)
        tips.push_back(i);
      return tips;
    }
    for (const std::string& name : words_of(s_, "tips", s_.need("tips")))
      tips.push_back(index_of(problem_.styli, name, s_, "tips"));
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
    if (setup_.kind == Kind::touch) {
      add_single_touches(touches, sigma, setup_);
    } else {
      add_centres(plan_, table.name, touches, sigma, setup_);
    }
  }

  MeasurementPlan& plan_;
  Problem& problem_;
  std::filesystem::path folder_;
  const TomlSection& s_;
  SetUp setup_;
};

}  // namespace

void read_setup(MeasurementPlan& plan, const std::filesystem::path& folder, const TomlSection& s) {
  SetUpReader(plan, folder, s).read();
}

}  // namespace volcomp::host::identify
