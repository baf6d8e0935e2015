// The NC program of a plan, read back: where it probes from and to, and that it stays within the
// travels and clear of the balls.

#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/measure/identify/planned_spheres.hpp"
#include "host_sim/host/measure/identify/touch_program.hpp"
#include "tests/host_sim/host/measure/identify/simulated_plan.hpp"

namespace volcomp::test {
namespace {

// A plan of two placements of the plate whose touches are to come.
MeasurementPlan planned(const std::vector<Placement>& poses) {
  MeasurementPlan plan = empty_plan();
  const Unknowns unknowns(plan.problem, true);
  const Problem ideal = plan.problem;
  for (const Placement& pose : poses) {
    SetUp setup;
    setup.name = "placement " + std::to_string(plan.problem.setups.size() + 1);
    setup.kind = ObservationKind::centre;
    setup.artefact = 0;
    setup.pose = pose;
    for (std::size_t tip = 0; tip < ideal.styli.size(); ++tip)
      for (std::size_t sphere = 0; sphere < ideal.artefacts[0].spheres.size(); ++sphere) {
        Pose q{};
        if (!stand_at(ideal, unknowns, VectorXd::Zero(unknowns.size()), ideal.styli[tip].offset,
                      pose.R * ideal.artefacts[0].spheres[sphere] + pose.t, q))
          continue;
        setup.q.push_back(q);
        setup.d.push_back({});
        setup.sphere.push_back(sphere);
        setup.stylus.push_back(tip);
        setup.sigma.insert(setup.sigma.end(), {1e-3, 1e-3, 1e-3});
      }
    plan.touched.emplace_back();
    plan.problem.setups.push_back(setup);
  }
  return plan;
}

struct Move {
  std::string word;  // G0, G1, G38.2
  Pose from{};
  Pose to{};
  std::size_t setup = 0;
  std::size_t sphere = 0;
  std::size_t tip = 0;
  std::string row;  // of touches.csv, after a probing move
};

// As a controller reads the program; a probing move ends at its target.
class Reader {
 public:
  explicit Reader(const MeasurementPlan& plan) : plan_(plan) {}

  std::vector<Move> read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line))
      take(line);
    return moves_;
  }
  [[nodiscard]] std::size_t pauses() const { return pauses_; }

 private:
  void take(const std::string& line) {
    if (line == "M0") {
      ++pauses_;
    } else if (line.rfind("(set-up ", 0) == 0) {
      const auto sphere = line.find(", sphere ");
      if (sphere != std::string::npos) now_.sphere = std::stoul(line.substr(sphere + 9));
      const auto tip = line.find(", tip ");
      now_.tip = named(plan_.problem.styli, line.substr(tip + 6, line.size() - tip - 7));
      now_.setup = named(plan_.problem.setups, line.substr(8, std::min(sphere, tip) - 8));
    } else if (line.rfind("(LOG,placement", 0) == 0) {
      moves_.back().row = line.substr(5, line.size() - 6);
    } else if (line.rfind("G0", 0) == 0 || line.rfind("G1", 0) == 0 ||
               line.rfind("G38.2", 0) == 0) {
      move(line);
    }
  }

  template <class Named>
  static std::size_t named(const std::vector<Named>& list, const std::string& name) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].name == name) return i;
    throw std::out_of_range(name);
  }

  void move(const std::string& line) {
    std::istringstream words(line);
    Move m = now_;
    words >> m.word;
    m.from = at_;
    std::string word;
    while (words >> word)
      if (word[0] != 'F') at_.at(plan_.machine.axis_index(word[0])) = std::stod(word.substr(1));
    m.to = at_;
    moves_.push_back(m);
  }

  const MeasurementPlan& plan_;
  Move now_;
  Pose at_{};
  std::size_t pauses_ = 0;
  std::vector<Move> moves_;
};

class Read {
 public:
  explicit Read(const MeasurementPlan& plan) : problem(plan.problem), program(touch_program(plan)) {
    Reader reader(plan);
    moves = reader.read(program.text);
    pauses = reader.pauses();
  }

  [[nodiscard]] Vec3 tip(const Move& m, const Pose& q) const {
    return ideal_geometry(problem.machine.chain, q).in_work(problem.styli[m.tip].offset);
  }
  [[nodiscard]] Vec3 centre(const Move& m, std::size_t sphere) const {
    const Placement& pose = *problem.setups[m.setup].pose;
    return pose.R * problem.artefacts[0].spheres[sphere] + pose.t;
  }
  [[nodiscard]] double apart(const Move& m) const {
    return problem.artefacts[0].radius[m.sphere] + problem.styli[m.tip].radius;
  }

  const Problem& problem;
  TouchProgram program;
  std::vector<Move> moves;
  std::size_t pauses = 0;
};

TEST(TouchProgram, ProbesFiveTimesASphereOnTheInwardNormal) {
  const MeasurementPlan plan = planned({placements()[0], placements()[4]});
  const Read read(plan);
  std::map<std::array<std::size_t, 3>, std::vector<Vec3>> normals;
  for (const Move& m : read.moves) {
    if (m.word != "G38.2") continue;
    const Vec3 centre = read.centre(m, m.sphere);
    const Vec3 from = read.tip(m, m.from) - centre;
    const Vec3 to = read.tip(m, m.to) - centre;
    // From so far outside, straight towards the centre, and not through it.
    EXPECT_GE(from.norm(), read.apart(m) + kClearance_mm - 1e-4);
    EXPECT_LE(to.norm(), read.apart(m) - kOvertravel_mm + 1e-4);
    EXPECT_NEAR(from.normalized().dot(to.normalized()), 1.0, 1e-9);
    normals[{m.setup, m.tip, m.sphere}].push_back(from.normalized());
  }
  std::size_t touches = 0;
  for (const auto& [which, list] : normals) {
    ASSERT_EQ(list.size(), 5U);
    touches += list.size();
    // The pole, away from what the balls stand on; the others round the equator.
    const Vec3 pole = plan.problem.setups[which[0]].pose->R.col(2);
    EXPECT_NEAR(list[0].dot(pole), 1.0, 1e-6);
    for (std::size_t k = 1; k < 5; ++k)
      EXPECT_NEAR(list[k].dot(pole), 0.0, 1e-4);
    EXPECT_NEAR((list[1] + list[2] + list[3] + list[4]).norm(), 0.0, 1e-3);
  }
  EXPECT_EQ(touches, read.program.touches);
  EXPECT_GT(touches, 0U);
  std::size_t observations = 0;
  for (const host::identify::SetUp& s : plan.problem.setups)
    observations += s.q.size();
  EXPECT_EQ(normals.size() + read.program.left_out.size(), observations);
}

TEST(TouchProgram, StaysWithinTheTravelsAndClearOfAllBalls) {
  const MeasurementPlan plan = planned(placements());
  const Read read(plan);
  for (std::size_t k = 0; k < read.moves.size(); ++k) {
    const Move& m = read.moves[k];
    for (std::size_t a = 0; a < 3; ++a) {
      const host::identify::Travel& travel = plan.problem.machine.travel.at(a);
      ASSERT_GE(m.to.at(a), travel.lo - 1e-5) << m.word;
      ASSERT_LE(m.to.at(a), travel.hi + 1e-5) << m.word;
    }
    // The way to a placement is the operator's and goes along the top.
    if (m.word == "G0") continue;
    for (std::size_t sphere = 0; sphere < plan.problem.artefacts[0].spheres.size(); ++sphere) {
      if (m.word == "G38.2" && sphere == m.sphere) continue;
      const bool back = k > 0 && read.moves[k - 1].word == "G38.2" && sphere == m.sphere;
      const Vec3 centre = read.centre(m, sphere);
      for (int part = back ? 10 : 0; part <= 10; ++part) {
        const Vec3 from = read.tip(m, m.from);
        const Vec3 at = from + 0.1 * part * (read.tip(m, m.to) - from);
        ASSERT_GE((at - centre).norm(), read.apart(m) + 0.99) << m.word << ' ' << sphere;
      }
    }
  }
}

TEST(TouchProgram, PausesForEveryPlacementAndTip) {
  const MeasurementPlan plan = planned({placements()[0], placements()[1]});
  const Read read(plan);
  std::map<std::array<std::size_t, 2>, std::size_t> blocks;
  for (const Move& m : read.moves)
    if (m.word == "G38.2") ++blocks[{m.setup, m.tip}];
  EXPECT_EQ(read.pauses, blocks.size());
  EXPECT_GT(read.pauses, 2U);
}

// Rows are those of touches.csv: names, parameters of the latched position, and the direction of
// the last move of each axis; after a pause the machine may come from anywhere.
TEST(TouchProgram, LogsARowOfTouchesAfterEveryProbingMove) {
  const MeasurementPlan plan = planned({placements()[0]});
  const Read read(plan);
  std::string arrived = "000";
  for (const Move& m : read.moves) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (m.word == "G0")
        arrived[a] = '0';
      else if (m.to.at(a) > m.from.at(a) || m.to.at(a) < m.from.at(a))
        arrived[a] = m.to.at(a) > m.from.at(a) ? '+' : '-';
    }
    if (m.word != "G38.2") continue;
    std::string wanted = plan.problem.setups[m.setup].name + "," + std::to_string(m.sphere) + "," +
                         plan.problem.styli[m.tip].name + ",#5061,#5062,#5063";
    for (const char direction : arrived)
      wanted += std::string(",") + direction;
    EXPECT_EQ(m.row, wanted);
  }
}

std::string refusal_of(const MeasurementPlan& plan) {
  try {
    static_cast<void>(touch_program(plan));
  } catch (const host::UserError& e) {
    return e.what();
  }
  return {};
}

TEST(TouchProgram, RefusesWhatItCannotTouch) {
  const MeasurementPlan good = planned({placements()[0]});
  MeasurementPlan plan = good;
  plan.problem.setups[0].kind = ObservationKind::rtest;
  EXPECT_THAT(refusal_of(plan), testing::HasSubstr("no set-up of kind centre or touch"));
  plan = good;
  plan.problem.setups[0].pose.reset();
  EXPECT_THAT(refusal_of(plan), testing::HasSubstr("has no 'pose_deg_mm'"));
  plan = good;
  plan.problem.artefacts[0].radius.clear();
  EXPECT_THAT(refusal_of(plan), testing::HasSubstr("artefact \"plate\" has no 'radius_mm'"));
  plan = good;
  plan.problem.styli[0].radius = 0.0;
  EXPECT_THAT(refusal_of(plan), testing::HasSubstr("stylus \"S0\" has no 'radius_mm'"));
  plan = good;
  plan.problem.setups[0].name = "first (of two)";
  EXPECT_THAT(refusal_of(plan), testing::HasSubstr("cannot stand in a program"));
}

}  // namespace
}  // namespace volcomp::test
