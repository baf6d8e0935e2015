// Where a machine works, what is stated of its campaign, and the noise that runs leave in their
// means.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/host/measure/whole_way/campaign_statement.hpp"
#include "host_sim/host/measure/whole_way/channel_noise.hpp"
#include "host_sim/host/measure/whole_way/task.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

class TaskOfMachine : public testing::Test {
 protected:
  MachineFile xyfz = read_machine_file(bundled_machine("xyfz"));
  MachineFile trunnion = read_machine_file(bundled_machine("trunnion"));

  std::string refused(const std::string& csv) const {
    return sim::complaint_of([&] {
      std::istringstream stream(csv);
      return read_task(stream, "task.csv", xyfz);
    });
  }
};

TEST_F(TaskOfMachine, IsAPointALineOrAFile) {
  const Task point = point_task("-1.5, -2,-3", xyfz);
  ASSERT_EQ(point.places.size(), 1U);
  EXPECT_EQ(point.places[0], (Pose{-1.5, -2.0, -3.0}));
  const Task line = line_task("0,0,0:-500,-300,-400", 5, xyfz);
  ASSERT_EQ(line.places.size(), 5U);
  EXPECT_EQ(line.places[1], (Pose{-125.0, -75.0, -100.0}));
  EXPECT_EQ(line.places[4], (Pose{-500.0, -300.0, -400.0}));
  std::istringstream csv("# a part\nZ [um],X [mm],Y [mm]\n-3000,-1,-2\n\n-4000,-5,-6\n");
  const Task file = read_task(csv, "task.csv", xyfz);
  ASSERT_EQ(file.places.size(), 2U);
  EXPECT_EQ(file.places[0], (Pose{-1.0, -2.0, -3.0}));
}

TEST_F(TaskOfMachine, RotaryAxesAreInDegrees) {
  const Task point = point_task("1,2,3,-90,180", trunnion);
  EXPECT_NEAR(point.places[0][3], -kPi / 2.0, 1e-15);
  EXPECT_NEAR(point.places[0][4], kPi, 1e-15);
  EXPECT_EQ(place_text(point.places[0], trunnion), "X 1 mm, Y 2 mm, Z 3 mm, A -90 deg, C 180 deg");
}

TEST_F(TaskOfMachine, MustBeWithinTheTravel) {
  const auto of = [&](const auto& work) { return sim::complaint_of(work); };
  EXPECT_EQ(of([&] { return point_task("-500,-300,-401", xyfz); }),
            "--point -500,-300,-401: Z -401 mm is outside the travel -400 … 0 mm");
  EXPECT_THAT(of([&] { return point_task("1,2", xyfz); }),
              HasSubstr("2 positions, the machine has the axes X Y Z"));
  EXPECT_THAT(of([&] { return point_task("1,2,x", xyfz); }), HasSubstr("is not a number"));
  EXPECT_THAT(of([&] { return point_task("nan,0,0", xyfz); }), HasSubstr("is not a number"));
  EXPECT_THAT(of([&] { return line_task("0,0,0", 5, xyfz); }), HasSubstr("a colon"));
  EXPECT_THAT(of([&] { return line_task("0,0,0:0,0,0", 5, xyfz); }), HasSubstr("the same place"));
}

TEST_F(TaskOfMachine, FileIsRefusedWithItsLine) {
  EXPECT_EQ(refused("X [mm],Y [mm],Z [mm]\n0,0,0\n0,1,0\n"),
            "task.csv:3: Y 1 mm is outside the travel -300 … 0 mm");
  EXPECT_THAT(refused("X [mm],Y [mm]\n"), HasSubstr("task.csv:1: the header lacks the column Z"));
  EXPECT_THAT(refused("X [mm],Y [mm],W [mm]\n"), HasSubstr("unknown column"));
  EXPECT_THAT(refused("X [mm],Y [mm],Z [deg]\n"), HasSubstr("unit of the wrong kind"));
  EXPECT_THAT(refused("X [mm],X [mm],Z [mm]\n"), HasSubstr("occurs twice"));
  EXPECT_THAT(refused("X [mm],Y [mm],Z [mm]\n0,0\n"),
              HasSubstr("task.csv:2: 2 cells instead of 3"));
  EXPECT_THAT(refused("X [mm],Y [mm],Z [mm]\n0,0,inf\n"), HasSubstr("must be finite"));
  EXPECT_THAT(refused("X [mm],Y [mm],Z [mm]\n"), HasSubstr("no place"));
  EXPECT_THAT(refused(""), HasSubstr("empty"));
}

TEST(CampaignStatement, IsATableOfItsOwn) {
  const CampaignStatement s =
      parse_campaign("[campaign]\nscale_um_per_m = 0.25\nlever_mm = 2\n", "u.toml");
  EXPECT_EQ(s.scale_um_per_m, 0.25);
  EXPECT_EQ(s.lever_mm, 2.0);
  EXPECT_FALSE(s.roll_urad.has_value());
  CampaignStatement option;
  option.lever_mm = 1.0;
  EXPECT_EQ(s.overridden_by(option).lever_mm, 1.0);
  EXPECT_EQ(s.overridden_by(option).scale_um_per_m, 0.25);
  const auto refused = [](const std::string& text) {
    return sim::complaint_of([&] { return parse_campaign(text, "u.toml"); });
  };
  EXPECT_THAT(refused("[campaign]\nlever_mm = -1\n"), HasSubstr("must not be negative"));
  EXPECT_THAT(refused("[campaign]\nlever_um = 1\n"), HasSubstr("lever_um"));
  EXPECT_THAT(refused("[uncertainty]\nlever_mm = 1\n"), HasSubstr("uncertainty"));
}

// Runs of X whose readings along X are normal with this deviation.
RunsFile noisy_runs(std::size_t up, std::size_t down, std::size_t targets, double sigma,
                    std::uint32_t campaign) {
  RunsFile runs;
  runs.letter = 'X';
  for (std::size_t t = 0; t < targets; ++t)
    runs.positions.push_back(100.0 * static_cast<double>(t));
  std::uint32_t reading = 0;
  const auto run = [&] {
    RunValues values(targets, ErrorMotion(ErrorMotion::Zero()));
    for (ErrorMotion& value : values)
      value(0) = sigma * normal(77, {1000, campaign, 0, reading++});
    return values;
  };
  for (std::size_t r = 0; r < up; ++r)
    runs.up.push_back(run());
  for (std::size_t r = 0; r < down; ++r)
    runs.down.push_back(run());
  return runs;
}

double mean_at(const std::vector<RunValues>& runs, std::size_t t) {
  double sum = 0.0;
  for (const RunValues& run : runs)
    sum += run[t](0);
  return sum / static_cast<double>(runs.size());
}

// How often the truth, 0, lies within 95 % of the draws about the mean of the last target, less
// that of the first, and within 1.96 standard uncertainties.
struct Covered {
  double draws = 0.0;
  double first_order = 0.0;
};

Covered coverage(std::size_t up, std::size_t down, std::size_t campaigns) {
  constexpr std::size_t kTargets = 5;
  constexpr std::size_t kDraws = 200;
  Covered covered;
  std::vector<double> noise;
  for (std::uint32_t campaign = 0; campaign < campaigns; ++campaign) {
    const RunsFile runs = noisy_runs(up, down, kTargets, 0.7e-3, campaign);
    const ChannelNoise channel(runs, 0, std::nullopt);
    EXPECT_EQ(channel.from(), ChannelNoise::From::runs);
    const double found = mean_at(runs.up, kTargets - 1) - mean_at(runs.up, 0);
    std::vector<double> drawn;
    for (std::uint32_t d = 0; d < kDraws; ++d) {
      channel.draw(1, d, campaign, noise);
      drawn.push_back(noise[kTargets - 1] - noise[0]);
    }
    std::sort(drawn.begin(), drawn.end());
    const double share = 1.0 / static_cast<double>(campaigns);
    if (drawn[4] <= -found && -found <= drawn[194]) covered.draws += share;
    const double u = std::hypot(channel.deviation(0), channel.deviation(kTargets - 1));
    if (std::abs(found) <= 1.96 * u) covered.first_order += share;
  }
  return covered;
}

// 95 % with a sampling error of 1.1 % (1 σ) of 400 campaigns.
TEST(ChannelNoise, CoversTheTruthInNinetyFiveOfAHundredCampaigns) {
  for (const auto& [up, down] : {std::pair<std::size_t, std::size_t>{5, 5}, {5, 0}, {4, 3}}) {
    const Covered covered = coverage(up, down, 400);
    EXPECT_NEAR(covered.draws, 0.95, 0.033) << up << ' ' << down;
    EXPECT_NEAR(covered.first_order, 0.95, 0.033) << up << ' ' << down;
  }
}

TEST(ChannelNoise, DrawsHaveTheDeviationThatIsPropagated) {
  const ChannelNoise channel(noisy_runs(5, 5, 11, 0.7e-3, 3), 0, std::nullopt);
  constexpr std::uint32_t kDraws = 4000;
  std::vector<double> squares(channel.columns(), 0.0);
  std::vector<double> noise;
  for (std::uint32_t d = 0; d < kDraws; ++d) {
    channel.draw(1, d, 0, noise);
    for (std::size_t j = 0; j < noise.size(); ++j)
      squares[j] += noise[j] * noise[j] / kDraws;
  }
  for (std::size_t j = 0; j < squares.size(); ++j)
    EXPECT_NEAR(std::sqrt(squares[j]) / channel.deviation(j), 1.0, 0.045);  // 4 σ: 22 columns
}

TEST(ChannelNoise, TooFewReadingsTellNothing) {
  const RunsFile single = noisy_runs(1, 1, 11, 0.7e-3, 1);
  EXPECT_EQ(ChannelNoise(single, 0, std::nullopt).from(), ChannelNoise::From::nothing);
  const ChannelNoise stated(single, 0, 2.0);
  EXPECT_EQ(stated.from(), ChannelNoise::From::statement);
  EXPECT_DOUBLE_EQ(stated.deviation(3), 2.0);
  // Two runs of four targets: seven degrees of freedom.
  EXPECT_EQ(ChannelNoise(noisy_runs(2, 2, 4, 1e-3, 1), 0, 2.0).from(),
            ChannelNoise::From::statement);
  // The other channels are all alike.
  EXPECT_EQ(ChannelNoise(noisy_runs(5, 5, 11, 1e-3, 1), 1, std::nullopt).from(),
            ChannelNoise::From::nothing);
}

}  // namespace
}  // namespace volcomp::host
