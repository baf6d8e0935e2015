#include "host_sim/host/measure/identify/touch_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/chain_geometry.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"
#include "host_sim/host/measure/identify/sphere_path.hpp"
#include "host_sim/host/report/charts.hpp"

namespace volcomp::host::identify {
namespace {

constexpr double kAbove_mm_min = 3000.0;
constexpr double kRetract_mm_min = 1200.0;
// A controller that reads the probe once a millisecond latches to 1 µm.
constexpr double kProbing_mm_min = 60.0;
constexpr double kStill = 1e-7;                // mm, rad
constexpr const char* kLetters = "XYZABCUVW";  // of #5061 to #5069

class Program {
 public:
  explicit Program(const MeasurementPlan& plan) : plan_(plan), problem_(plan.problem) {
    std::string columns = "setup,sphere,tip";
    for (const AxisFile& axis : plan.machine.axes)
      columns += fmt::format(",{} [{}]", axis.letter, axis.rotary ? "deg" : "mm");
    for (const AxisFile& axis : plan.machine.axes)
      columns += fmt::format(",direction {}", axis.letter);
    add("%");
    comment(fmt::format("touches of the spheres of {}", plan.path));
    comment("Work offsets are zero and no tool length is active: positions are those of the");
    comment(
        fmt::format("machine file. Every ball is free at its pole and all round; its place is "
                    "known to {:g} mm.",
                    kOvertravel_mm));
    comment("Ways are clear of the balls of the artefact for the ball of the tip alone: neither");
    comment("its shaft nor what holds the balls is known here. Run it first without artefact.");
    comment("LOG writes the latched positions, parameters 5061 and on, to touches.csv: as");
    comment("LinuxCNC does. Other controllers: the same rows, from what the drives latch.");
    add("G21 G90 G94 G40 G49 G80");
    add("(LOGOPEN,touches.csv)");
    add(fmt::format("(LOG,{})", columns));
  }

  // The artefact has been placed and the tip is in the spindle.
  void begin(const SetUp& s, const Stylus& tip, const SpherePaths& paths, const Pose& above) {
    comment(fmt::format("set-up {}, tip {}", s.name, tip.name));
    const std::string turned = turn(above);
    add(fmt::format("(MSG,Set-up {}: {}, tip {}.{}{} Resume when it is in its place.)", s.name,
                    problem_.artefacts[*s.artefact].name, tip.name,
                    turned.empty() ? "" : " Turns to" + turned + ".",
                    paths.above_all() ? "" : " Balls stand higher than this tip rises: look out."));
    add("M0");
    at_.reset();
    arrived_.fill('0');
    rise(paths.up(), above);
    go("G0", above, {});
  }
  // Where the rotary axes stand; empty without them.
  [[nodiscard]] std::string turn(const Pose& q) const {
    std::string words;
    for (std::size_t a = 0; a < plan_.machine.axes.size(); ++a)
      if (plan_.machine.axes[a].rotary)
        words += fmt::format(" {}{:.6g}", plan_.machine.axes[a].letter, kDegPerRad * q.at(a));
    return words;
  }

  // Up first, wherever the machine stands.
  void rise(const Vec3& up, const Pose& above) {
    std::string line = "G0";
    for (std::size_t a = 0; a < plan_.machine.axes.size(); ++a) {
      if (!raises(up, above, a)) continue;
      line += word(a, above.at(a));
      arrive(a, above);
      if (at_) at_->at(a) = above.at(a);
    }
    add(line);
  }

  void touch(const SetUp& s, std::size_t i, const SpherePath& path) {
    comment(fmt::format("set-up {}, sphere {}, tip {}", s.name, s.sphere[i],
                        problem_.styli[s.stylus[i]].name));
    for (const Pose& q : path.to_first)
      go("G1", q, kAbove_mm_min);
    for (const SphereTouch& t : path.touches) {
      for (const Pose& q : t.way)
        go("G1", q, kAbove_mm_min);
      go("G38.2", t.target, kProbing_mm_min);
      add(row(s, i));
      go("G1", t.way.back(), kRetract_mm_min);
    }
    for (const Pose& q : path.away)
      go("G1", q, kAbove_mm_min);
  }

  std::string end() {
    add("(LOGCLOSE)");
    add("M2\n%");
    return std::move(text_);
  }

 private:
  void add(const std::string& line) { text_ += line + "\n"; }
  void comment(std::string words) {
    std::replace(words.begin(), words.end(), '(', '[');
    std::replace(words.begin(), words.end(), ')', ']');
    add("(" + words + ")");
  }

  [[nodiscard]] std::string word(std::size_t a, double q) const {
    const AxisFile& axis = plan_.machine.axes[a];
    return axis.rotary ? fmt::format(" {}{:.6f}", axis.letter, kDegPerRad * q)
                       : fmt::format(" {}{:.5f}", axis.letter, q);
  }
  // Whether an axis takes part in moving up.
  [[nodiscard]] bool raises(const Vec3& up, const Pose& q, std::size_t a) const {
    constexpr double kPart = 1e-6;
    const Pose higher = moved(problem_.machine.chain, q, up);
    return std::abs(higher.at(a) - q.at(a)) > kPart;
  }

  void arrive(std::size_t a, const Pose& to) {
    if (!at_)
      arrived_.at(a) = '0';
    else if (std::abs(to.at(a) - at_->at(a)) > kStill)
      arrived_.at(a) = to.at(a) > at_->at(a) ? '+' : '-';
  }

  // Axes that stand still have no word: interpreters refuse rotary words in G38.2.
  void go(const char* kind, const Pose& to, std::optional<double> feed) {
    std::string line = kind;
    for (std::size_t a = 0; a < plan_.machine.axes.size(); ++a) {
      if (at_ && std::abs(at_->at(a) - to.at(a)) <= kStill) continue;
      line += word(a, to.at(a));
      arrive(a, to);
    }
    if (line == kind) return;
    at_ = to;
    add(line + (feed ? fmt::format(" F{:.0f}", *feed) : ""));
  }

  [[nodiscard]] std::string row(const SetUp& s, std::size_t i) const {
    std::string line =
        fmt::format("(LOG,{},{},{}", s.name, s.sphere[i], problem_.styli[s.stylus[i]].name);
    const std::string letters = kLetters;
    for (const AxisFile& axis : plan_.machine.axes)
      line += fmt::format(",#{}", 5061 + letters.find(axis.letter));
    for (std::size_t a = 0; a < plan_.machine.axes.size(); ++a)
      line += fmt::format(",{}", arrived_.at(a));
    return line + ")";
  }

  const MeasurementPlan& plan_;
  const Problem& problem_;
  std::optional<Pose> at_;  // none: anywhere
  // In which direction each axis came to where it stands; 0: not known.
  std::array<char, kMaxAxes> arrived_{};
  std::string text_;
};

void require_name(const MeasurementPlan& plan, const std::string& name) {
  if (name.find_first_of(R"(,()#%;")") != std::string::npos)
    throw UserError(
        fmt::format(R"({}: the name "{}" cannot stand in a program: it holds one of , ( ) # % ; ")",
                    plan.path, name));
}

void require_pose(const MeasurementPlan& plan, const SetUp& s) {
  if (!s.pose)
    throw UserError(fmt::format("{}: set-up \"{}\" has no 'pose_deg_mm', which a program needs",
                                plan.path, s.name));
}

void require_radii(const MeasurementPlan& plan, const SetUp& s) {
  const Artefact& artefact = plan.problem.artefacts[*s.artefact];
  if (artefact.radius.empty())
    throw UserError(fmt::format("{}: artefact \"{}\" has no 'radius_mm', which a program needs",
                                plan.path, artefact.name));
  for (const std::size_t tip : s.stylus)
    if (!(plan.problem.styli[tip].radius > 0.0))
      throw UserError(fmt::format("{}: stylus \"{}\" has no 'radius_mm', which a program needs",
                                  plan.path, plan.problem.styli[tip].name));
}

void require_letters(const MeasurementPlan& plan) {
  const std::string letters = kLetters;
  for (const AxisFile& axis : plan.machine.axes)
    if (letters.find(axis.letter) == std::string::npos)
      throw UserError(
          fmt::format("{}: a program has no axis {}, only {}", plan.path, axis.letter, kLetters));
}

// The spheres of a set-up, each once for every tip and rotary position, with the tip in its centre;
// single touches of a sphere stand one after the other.
SetUp centred(const Problem& problem, const SetUp& s) {
  const MachineChain& chain = problem.machine.chain;
  const Artefact& artefact = problem.artefacts[*s.artefact];
  SetUp out = s;
  out.q.clear();
  out.sphere.clear();
  out.stylus.clear();
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const std::size_t stylus = *problem.stylus_of(s, i);
    const Vec3 centre = s.pose->R * artefact.spheres[s.sphere[i]] + s.pose->t;
    const Pose q =
        s.kind == ObservationKind::centre
            ? s.q[i]
            : moved(chain, s.q[i],
                    centre - ideal_geometry(chain, s.q[i]).in_work(problem.styli[stylus].offset));
    const bool again = !out.q.empty() && out.sphere.back() == s.sphere[i] &&
                       out.stylus.back() == stylus && problem.same_turn(out.q.back(), q);
    if (again) continue;
    out.q.push_back(q);
    out.sphere.push_back(s.sphere[i]);
    out.stylus.push_back(stylus);
  }
  return out;
}

// Observations by tip and rotary position, in the order of the plan: the machine pauses before
// each.
std::vector<std::vector<std::size_t>> by_tip(const Problem& problem, const SetUp& s) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    const auto same = [&](const std::vector<std::size_t>& group) {
      return s.stylus[group.front()] == s.stylus[i] &&
             problem.same_turn(s.q[group.front()], s.q[i]);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) {
      groups.push_back({i});
    } else {
      found->push_back(i);
    }
  }
  return groups;
}

}  // namespace

TouchProgram touch_program(const MeasurementPlan& plan) {
  require_letters(plan);
  TouchProgram out;
  Program program(plan);
  bool any = false;
  for (const SetUp& measured : plan.problem.setups) {
    if (!measured.has_pose()) continue;
    any = true;
    require_name(plan, measured.name);
    require_name(plan, plan.problem.artefacts[*measured.artefact].name);
    require_pose(plan, measured);
    const SetUp s = centred(plan.problem, measured);
    require_radii(plan, s);
    for (const std::vector<std::size_t>& group : by_tip(plan.problem, s)) {
      const Stylus& tip = plan.problem.styli[s.stylus[group.front()]];
      require_name(plan, tip.name);
      const SpherePaths paths(plan.problem, s, group);
      std::optional<Vec3> last;
      Pose above{};
      for (const std::size_t i : group) {
        const std::optional<SpherePath> path = paths.of(i);
        if (!path || (last && !paths.may_travel(*last, path->begin))) {
          out.left_out.push_back(fmt::format("{}: sphere {} with tip {}{}", s.name, s.sphere[i],
                                             tip.name, program.turn(s.q[i])));
          continue;
        }
        if (!last) program.begin(s, tip, paths, path->above);
        program.touch(s, i, *path);
        out.touches += path->touches.size();
        last = path->end;
        above = path->above_end;
      }
      if (last) program.rise(paths.up(), above);
    }
  }
  if (!any)
    throw UserError(fmt::format("{}: there is no set-up of kind centre or touch", plan.path));
  if (out.touches == 0)
    throw UserError(fmt::format("{}: no sphere has room to approach it", plan.path));
  out.text = program.end();
  return out;
}

}  // namespace volcomp::host::identify
