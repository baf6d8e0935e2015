// Rotary axes that are beside their place are found there, whatever carries them and whatever their
// runs have seen of it.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/measure/identify/problem.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/tables/build_tables.hpp"
#include "host_sim/sim/campaign/any_axes.hpp"
#include "host_sim/sim/campaign/located_runs.hpp"
#include "host_sim/sim/campaign/rotary_locations.hpp"
#include "host_sim/sim/truth/drawn_machine.hpp"

namespace volcomp::sim {
namespace {

host::MachineFile bundled(const std::string& name) {
  return host::read_machine_file(host::bundled_machine(name));
}

// Nothing is wrong but where its rotary axes are; another place for another seed.
TrueMachine beside_its_place(const host::MachineFile& file, std::uint64_t seed) {
  TrueMachine truth = ideal_machine(file);
  Random random(seed);
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    if (!file.axes[a].rotary) continue;
    ErrorMotion location;
    for (Eigen::Index c = 0; c < 6; ++c)
      location(c) = (c < 3 ? 15e-3 : 30e-6) * random.uniform(-1.0, 1.0);
    set_location(file.chain.axis(a), location, truth.axis[a]);
  }
  return truth;
}

// Tables of a machine that is right but for what is asked.
VolumetricModel without_tables(const host::MachineFile& file) {
  VolumetricModel model;
  model.chain = file.chain;
  model.tool_point = file.chain.tool_point();
  return model;
}

std::unique_ptr<host::BuiltTables> build(const Campaign& campaign) {
  host::BuildOptions how = host::tables_only(host::ModelKind::abbe_closed);
  how.slope = SlopeFit::keep;
  return host::build_tables(campaign.machine, campaign.runs, how);
}

// EX0C of the fixed side, EX1B of the moving one.
double true_value(const TrueMachine& truth, const host::MachineFile& file,
                  const LocationValue& value) {
  const AverageLine line = true_line(truth, file, file.axis_index(value.name.back()));
  const auto& names = host::identify::kChannelNames;
  const auto channel = std::find(names.begin(), names.end(), value.name.substr(0, 2));
  return (value.name[2] == '0' ? line.fixed : line.moving)(channel - names.begin());
}

void expect_exact(const RotaryLocations& locations, const TrueMachine& truth,
                  const host::MachineFile& file) {
  for (const LocationValue& v : locations.found)
    EXPECT_NEAR(v.found, true_value(truth, file, v), v.angular ? 1e-9 : 1e-6) << v.name;
}

TEST(RotaryLocations, OfATrunnionAllEightAreFound) {
  const host::MachineFile file = bundled("trunnion");
  const TrueMachine truth = beside_its_place(file, 3);
  const RotaryLocations found = locate_rotary_axes(truth, file, without_tables(file), {true, 3});
  EXPECT_EQ(found.found.size(), 8U);
  EXPECT_TRUE(found.assumed.empty());
  expect_exact(found, truth, file);
}

TEST(RotaryLocations, NoThirdSlideHasToFollow) {
  for (const char* name : {"yk7280", "internal_grinder"}) {
    const host::MachineFile file = bundled(name);
    const TrueMachine truth = beside_its_place(file, 5);
    const RotaryLocations found = locate_rotary_axes(truth, file, without_tables(file), {true, 5});
    EXPECT_EQ(found.found.size(), 4U) << name;
    expect_exact(found, truth, file);
  }
}

TEST(RotaryLocations, AMachineWithoutRotaryAxesHasNone) {
  const host::MachineFile file = bundled("xyfz");
  const RotaryLocations found =
      locate_rotary_axes(ideal_machine(file), file, without_tables(file), {true, 1});
  EXPECT_TRUE(found.found.empty());
}

// X and Y slide and A turns the work about X: along X and Z places of A and B move everything
// alike, or as each other. What is held instead makes no difference anywhere.
TEST(RotaryLocations, WhatNoPlaceShowsIsNamedAndMakesNoDifference) {
  const host::MachineFile file = bundled("l300g");
  const TrueMachine truth = beside_its_place(file, 7);
  const RotaryLocations found = locate_rotary_axes(truth, file, without_tables(file), {true, 7});
  EXPECT_THAT(found.assumed, testing::ElementsAre("EZ0B", "EZ0A"));
  EXPECT_EQ(found.found.size(), 6U);
  Random random(7);
  std::vector<host::VolumePoint> left;
  for (int i = 0; i < 200; ++i) {
    Pose q{};
    ErrorSet errors = zero_errors();
    for (std::size_t a = 0; a < file.axes.size(); ++a) {
      q[a] = random.uniform(file.axes[a].lo, file.axes[a].hi);
      errors[a] = error_of(found.place.at(a), file.chain.axis(a), q[a]);
    }
    const PointPair points = ideal_points(file.chain, q, file.chain.tool_point());
    const VolumetricError e =
        exact_error(file.chain, q, errors, Vec3::Zero(), RotationModel::rxryrz, points);
    left.push_back({points.work, truth.error(q, {}, points.tool).position_work - e.position_work});
  }
  EXPECT_LT(host::aligned_volume_figures(left).max_um, 2e-3);
}

// The runs of the simulated laser have seen where the axis is; after that they have not, but for
// the nanometre and the nanoradian it counts in.
TEST(RotaryLocations, RunsAreMadeToForgetThem) {
  const host::MachineFile file = bundled("trunnion");
  Campaign campaign = measure_any_machine(beside_its_place(file, 9), file, no_noise(), 1, {});
  const auto rise = [](const host::RunsFile& runs) {
    double most = 0.0;
    for (const ErrorMotion& e : runs.up[0])
      most = std::max(most, (e - runs.up[0][0]).cwiseAbs().maxCoeff());
    return most;
  };
  EXPECT_GT(rise(campaign.runs[4]), 5e-3);
  forget_places(campaign);
  for (const std::size_t a : {3U, 4U})
    EXPECT_LT(rise(campaign.runs[a]), 4e-6);
}

// Runs, places and runs with these places: the tables are those of the machine, at its references
// and everywhere. Behind a machine with errors in every channel.
TEST(RotaryLocations, TablesHoldThePlaceThatWasFound) {
  const host::MachineFile file = bundled("trunnion");
  TrueMachine truth = counted_from_references(draw_machine(file, 4), file);
  for (TrueAxis& axis : truth.axis)
    axis.reversal = {};
  Campaign campaign = measure_any_machine(truth, file, no_noise(), 1, {});
  forget_places(campaign);
  const RotaryLocations found =
      locate_rotary_axes(truth, campaign.machine, build(campaign)->model, {true, 4});
  put_in_place(found.place, campaign);
  const auto tables = build(campaign);
  for (const std::size_t a : {3U, 4U}) {
    for (const double q : file.axes[a].all_targets()) {
      Pose pose{};
      pose[a] = q;
      const ErrorMotion off =
          tables->model.errors(pose, kUnknownTravels)[a] - truth.errors(pose, {})[a];
      EXPECT_LT(off.head<3>().norm(), 0.1e-3) << a << " at " << q;
      EXPECT_LT(off.tail<3>().norm(), 0.3e-6) << a << " at " << q;
    }
  }
}

struct Scatter {
  double rms = 0.0;
  double most = 0.0;
  int count = 0;

  void add(double value) {
    rms = std::sqrt((count * rms * rms + value * value) / (count + 1));
    most = std::max(most, std::abs(value));
    ++count;
  }
};

// Axes that grow between the stations are not in the uncertainty, and hardly show.
TEST(RotaryLocations, TheirUncertaintyIsWhatReadingsScatterThemBy) {
  const host::MachineFile file = bundled("trunnion");
  Scatter scatter;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TrueMachine truth = beside_its_place(file, seed);
    const RotaryLocations found =
        locate_rotary_axes(truth, file, without_tables(file), {false, seed});
    for (const LocationValue& v : found.found)
      scatter.add((v.found - true_value(truth, file, v)) / v.u);
  }
  EXPECT_EQ(scatter.count, 160);
  EXPECT_NEAR(scatter.rms, 1.0, 0.2);
  EXPECT_LT(scatter.most, 3.0);
}

// They count from the axes as the tables have them: what noise has put into the runs and into the
// squareness moves them by more than the readings do.
TEST(RotaryLocations, NoiseOfTheRunsComesOnTop) {
  const host::MachineFile file = bundled("trunnion");
  Scatter mm;
  Scatter rad;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TrueMachine truth = beside_its_place(file, seed);
    Campaign campaign = measure_any_machine(truth, file, {}, 5, {seed, 0});
    forget_places(campaign);
    const RotaryLocations found =
        locate_rotary_axes(truth, campaign.machine, build(campaign)->model, {false, seed});
    for (const LocationValue& v : found.found)
      (v.angular ? rad : mm).add(v.found - true_value(truth, file, v));
  }
  EXPECT_LT(mm.rms, 1.5e-3);
  EXPECT_LT(rad.rms, 5e-6);
}

}  // namespace
}  // namespace volcomp::sim
