// The NC programs of the inspection, read back: what they command, on the machine as it really is.

#include <array>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/tables/volumetric.hpp"
#include "host_sim/experiments/l300g/inspection_program.hpp"
#include "host_sim/experiments/l300g/traced_grinder.hpp"

namespace volcomp::sim {
namespace {

// One block: word → value; comments and % have none.
using Block = std::map<char, double>;

std::vector<Block> blocks_of(const std::string& program) {
  std::vector<Block> blocks;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '%' || line.front() == '(') continue;
    Block block;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      std::size_t read = 0;
      const double value = std::stod(word.substr(1), &read);
      EXPECT_EQ(read + 1, word.size()) << line;
      EXPECT_TRUE(block.emplace(word.front(), value).second || word.front() == 'G') << line;
    }
    blocks.push_back(block);
  }
  return blocks;
}

// Where the axes stand after each block that names them: words are modal.
struct Station {
  Pose pose{};
  bool probes = false;
};

std::vector<Station> stations_of(const std::vector<Block>& blocks) {
  std::vector<Station> stations;
  Pose pose{};
  for (const Block& block : blocks) {
    const double scale[] = {1.0, 1.0, kPi / 180.0, kPi / 180.0};
    bool moves = false;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto word = block.find("XYBA"[a]);
      if (word == block.end()) continue;
      pose[a] = scale[a] * word->second;
      moves = true;
    }
    if (moves) stations.push_back({pose, block.at('G') > 38.0});
  }
  return stations;
}

// The machine with these errors, what identification finds of them, and both programs.
struct Planned {
  explicit Planned(const std::string& errors)
      : file(host::read_machine_file(host::bundled_machine("l300g"))),
        truth(l300g::make_l300g_truth(file, l300g::grinder_errors(errors), 1)),
        setup{l300g::grinder_geometry(file.chain), l300g::master_gear(), PathStyle::fixed_a,
              1.4935} {
    const TracedErrors found = trace_errors(truth, file, l300g::traced_plan(), {true});
    before = l300g::inspection_program(setup, "before", l300g::no_offset);
    after = l300g::inspection_program(setup, "after", [&](const Pose& q) {
      return l300g::compensation_at(found.built->model, q);
    });
  }
  host::MachineFile file;
  TrueMachine truth;
  l300g::InspectionSetup setup;
  std::string before;
  std::string after;
};

// In the frame of the gear, mm.
Vec3 ideal_centre(const MachineChain& chain, const Pose& pose) {
  return ideal_points(chain, pose, chain.tool_point()).work;
}
Vec3 real_centre(const TrueMachine& truth, const Pose& pose) {
  return ideal_centre(truth.chain, pose) +
         truth.error(pose, {}, truth.chain.tool_point()).position_work;
}

TEST(L300gProgram, HasTheWordsOfATouchAndNoOthers) {
  const Planned p8("p8");
  const std::vector<Block> blocks = blocks_of(p8.before);
  std::size_t touches = 0;
  for (const Block& block : blocks) {
    for (const auto& [word, value] : block)
      EXPECT_NE(std::string("GXYBAFM").find(word), std::string::npos) << word;
    const auto g = block.find('G');
    if (g == block.end() || g->second < 38.0 || g->second > 39.0) continue;
    EXPECT_DOUBLE_EQ(g->second, 38.2);
    EXPECT_GT(block.at('F'), 0.0);
    EXPECT_EQ(block.count('X') + block.count('Y') + block.count('A'), 0U);
    ++touches;
  }
  EXPECT_EQ(blocks.back().at('M'), 2.0);
  const InvoluteGear& gear = p8.setup.gear;
  std::size_t planned = 0;
  for (const FlankSide side : l300g::kSides)
    planned += l300g::profile_touches(gear, {side, 0}).size() +
               l300g::lead_touches(gear, {side, 0}).size() +
               l300g::pitch_touches(gear, side).size();
  EXPECT_EQ(touches, planned);
}

struct Distances {
  double uncompensated = 0.0;
  double compensated = 0.0;
};

// From where an ideal machine stands in the first program: the machine as it is, in either, where
// touches end. mm
Distances largest_distances(const Planned& planned) {
  const auto before = stations_of(blocks_of(planned.before));
  const auto after = stations_of(blocks_of(planned.after));
  EXPECT_EQ(before.size(), after.size());
  Distances largest;
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    EXPECT_EQ(before[i].probes, after[i].probes);
    EXPECT_DOUBLE_EQ(before[i].pose[3], after[i].pose[3]) << "A does not correct";
    if (!before[i].probes) continue;
    const Vec3 aim = ideal_centre(planned.file.chain, before[i].pose);
    const auto away = [&](const Pose& q) { return (real_centre(planned.truth, q) - aim).norm(); };
    largest.uncompensated = std::max(largest.uncompensated, away(before[i].pose));
    largest.compensated = std::max(largest.compensated, away(after[i].pose));
  }
  return largest;
}

// The coordinates differ by the compensation. Words of 0.01 µm and 10⁻⁶°; a touch is compensated
// for its contact, 0.2 mm from where it may end at the latest: 50 µm of errors turn with B by 1.2
// mrad.
TEST(L300gProgram, CompensatedCoordinatesPutTheRealMachineWhereTheOthersAimed) {
  const Distances p8_distances = largest_distances(Planned("p8"));
  EXPECT_GT(p8_distances.uncompensated, 0.04);
  EXPECT_LT(p8_distances.compensated, 0.1e-3);
}

// Waves of A, 40° long, between knots that are 5° apart.
TEST(L300gProgram, WavesLeaveWhatTheKnotsCannotHold) {
  const Distances varied = largest_distances(Planned("p8-variation"));
  EXPECT_GT(varied.uncompensated, 0.04);
  EXPECT_LT(varied.compensated, 0.5e-3);
}

// But for the last digit of a word, of 0.01 µm and 10⁻⁶°: what is known beforehand of where the
// reflectors are, 20 µm, keeps the estimate 0.2 nm from nothing.
TEST(L300gProgram, NothingToCompensateNothingChanged) {
  constexpr std::array<double, 4> kWord{1.001e-5, 1.001e-5, 1.76e-8, 1.76e-8};
  const Planned good("none");
  const auto before = stations_of(blocks_of(good.before));
  const auto after = stations_of(blocks_of(good.after));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t a = 0; a < 4; ++a)
      EXPECT_NEAR(before[i].pose[a], after[i].pose[a], kWord.at(a));
  }
}

}  // namespace
}  // namespace volcomp::sim
