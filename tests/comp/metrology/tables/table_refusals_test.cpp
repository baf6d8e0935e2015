// Every measured run that must be refused, with the place the refusal names.

#include <cstring>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/comp/metrology/tables/campaign.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/exact_chain.hpp"

namespace volcomp::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

std::unique_ptr<Campaign> good() {
  auto c = std::make_unique<Campaign>(Axis::x, uniform_targets(-500.0, 50.0, 11));
  for (int run = 0; run < 5; ++run) {
    c->add_up(no_error);
    c->add_down(no_error);
  }
  c->measured.sensed_at_zero = Vec3(250, 0, 550);
  c->measured.kappa = 1;
  return c;
}

// Builds into a table full of something else and expects that to be intact.
Status refused(Campaign& c) {
  auto out = std::make_unique<BuiltTable>();
  out->targets = 77;
  out->table.forward[3] = ErrorMotion::Constant(0.125);
  std::vector<unsigned char> before(sizeof *out);
  std::memcpy(before.data(), out.get(), sizeof *out);
  const Status status = c.build(*out);
  EXPECT_FALSE(status.ok());
  EXPECT_EQ(std::memcmp(before.data(), out.get(), sizeof *out), 0) << "written on refusal";
  EXPECT_EQ(status.where.axis, 'X');
  return status;
}

TEST(TableRefusal, TheUndamagedCampaignIsAccepted) {
  BuiltTable built;
  ASSERT_TRUE(good()->build(built).ok());
  EXPECT_EQ(built.warning_count, 0U);
}

TEST(TableRefusal, MissingFieldsHaveNoDefault) {
  auto c = good();
  c->measured.convention.reset();
  EXPECT_EQ(refused(*c).reason, Reason::missing_field);
  EXPECT_STREQ(refused(*c).where.field, "convention");
  c = good();
  c->measured.sensed_at_zero.reset();
  EXPECT_EQ(refused(*c).reason, Reason::missing_field);
  EXPECT_STREQ(refused(*c).where.field, "L0");
  c = good();
  c->measured.kappa.reset();
  EXPECT_EQ(refused(*c).reason, Reason::missing_field);
  EXPECT_STREQ(refused(*c).where.field, "kappa");
}

TEST(TableRefusal, NotFiniteReadingIsLocated) {
  for (const double bad : {kNan, kInf, -kInf}) {
    auto c = good();
    c->down[3][7](4) = bad;
    const Status s = refused(*c);
    EXPECT_EQ(s.reason, Reason::not_finite);
    EXPECT_STREQ(s.where.direction, "down");
    EXPECT_EQ(s.where.run, 3);
    EXPECT_EQ(s.where.target, 7);
    EXPECT_EQ(s.where.channel, 4);
  }
}

TEST(TableRefusal, NotFinitePositionIsLocated) {
  auto c = good();
  c->positions[4] = kNan;
  EXPECT_EQ(refused(*c).reason, Reason::not_finite);
  EXPECT_EQ(refused(*c).where.target, 4);
  EXPECT_STREQ(refused(*c).where.field, "position");
}

TEST(TableRefusal, ImplausibleMagnitudesAreUnits) {
  struct Limit {
    Eigen::Index channel;
    double good;
    double bad;
  };
  for (const Limit& l : {Limit{0, 1.0, 1.001}, Limit{2, -1.0, -1.001}, Limit{5, 5e-3, 5.001e-3},
                         Limit{3, -5e-3, -5.001e-3}}) {
    auto c = good();
    c->up[2][6](l.channel) = l.good;
    BuiltTable built;
    EXPECT_TRUE(c->build(built).ok()) << l.good;
    c->up[2][6](l.channel) = l.bad;
    const Status s = refused(*c);
    EXPECT_EQ(s.reason, Reason::unit_suspected);
    EXPECT_STREQ(s.where.direction, "up");
    EXPECT_EQ(s.where.run, 2);
    EXPECT_EQ(s.where.target, 6);
    EXPECT_EQ(s.where.channel, l.channel);
    EXPECT_EQ(s.where.value, l.bad);
  }
}

TEST(TableRefusal, PositionsOutOfOrderNameTheFirstBadIndex) {
  auto c = good();
  std::swap(c->positions[4], c->positions[5]);
  EXPECT_EQ(refused(*c).reason, Reason::positions_not_monotone);
  EXPECT_EQ(refused(*c).where.target, 5);
  c = good();
  c->positions[8] = c->positions[7];
  EXPECT_EQ(refused(*c).reason, Reason::positions_duplicate);
  EXPECT_EQ(refused(*c).where.target, 8);
}

// The same mistakes in a list that runs downwards, as Table 5 does: same reasons, and the index is
// that of the user's list.
TEST(TableRefusal, MistakesInDescendingListsAreNamedAsWritten) {
  const auto descending = [] {
    auto c = good();
    c->positions = uniform_targets(0.0, -50.0, 11);
    return c;
  };
  auto c = descending();
  c->positions[8] = c->positions[7];
  EXPECT_EQ(refused(*c).reason, Reason::positions_duplicate);
  EXPECT_EQ(refused(*c).where.target, 8);
  c = descending();
  std::swap(c->positions[4], c->positions[5]);
  EXPECT_EQ(refused(*c).reason, Reason::positions_not_monotone);
  EXPECT_EQ(refused(*c).where.target, 5);
  c = descending();
  c->up[1][3](0) = kNan;
  EXPECT_EQ(refused(*c).where.target, 3);
  c->up[1][3](0) = 2.0;
  EXPECT_EQ(refused(*c).reason, Reason::unit_suspected);
  EXPECT_EQ(refused(*c).where.target, 3);
  c = descending();
  c->positions[2] += 4.0;
  EXPECT_EQ(refused(*c).reason, Reason::positions_not_uniform);
  EXPECT_EQ(refused(*c).where.target, 2);
  EXPECT_NEAR(refused(*c).where.deviation, 4.0, 1e-12);
}

TEST(TableRefusal, NonUniformPositionsNameIndexAndDeviation) {
  auto c = good();
  c->positions[3] += 0.9e-3;
  BuiltTable built;
  EXPECT_TRUE(c->build(built).ok()) << "within 1 µm";
  c->positions[3] += 0.2e-3;
  const Status s = refused(*c);
  EXPECT_EQ(s.reason, Reason::positions_not_uniform);
  EXPECT_EQ(s.where.target, 3);
  EXPECT_NEAR(s.where.deviation, 1.1e-3, 1e-12);
}

TEST(TableRefusal, GapsBeyondTwiceTheMedianAreNotInvented) {
  auto c = good();
  c->measured.allow_resampling = true;
  c->positions[10] = 50.0;  // gap 100 = 2 × 50
  BuiltTable built;
  EXPECT_TRUE(c->build(built).ok());
  c->positions[10] = 50.1;
  const Status s = refused(*c);
  EXPECT_EQ(s.reason, Reason::gap_too_large);
  EXPECT_EQ(s.where.target, 10);
  EXPECT_NEAR(s.where.value, 100.1, 1e-12);
}

TEST(TableRefusal, RunsThatAreShortMissingOrTooMany) {
  auto c = good();
  c->down[4].pop_back();
  EXPECT_EQ(refused(*c).reason, Reason::run_length);
  EXPECT_STREQ(refused(*c).where.direction, "down");
  EXPECT_EQ(refused(*c).where.run, 4);
  EXPECT_EQ(refused(*c).where.count, 10);
  c = good();
  c->up.clear();
  c->down.clear();
  EXPECT_EQ(refused(*c).reason, Reason::no_runs);
  c = good();
  while (c->up.size() < 101)
    c->add_up(no_error);
  EXPECT_EQ(refused(*c).reason, Reason::too_many_runs);
}

TEST(TableRefusal, TooFewAndTooManyTargets) {
  Campaign one(Axis::x, {0.0});
  one.add_up(no_error);
  EXPECT_EQ(refused(one).reason, Reason::too_few_knots);
  EXPECT_EQ(refused(one).where.count, 1);
  Campaign none(Axis::x, {});
  EXPECT_EQ(refused(none).reason, Reason::too_few_knots);
  Campaign many(Axis::x, uniform_targets(0.0, 1.0, static_cast<int>(kTableKnots) + 1));
  many.add_up(no_error);
  EXPECT_EQ(refused(many).reason, Reason::too_many_knots);
}

TEST(TableRefusal, ReferenceOutsideTheTable) {
  for (const int reference : {-1, 11, 1000000}) {
    auto c = good();
    c->measured.reference = reference;
    EXPECT_EQ(refused(*c).reason, Reason::reference_out_of_range);
    EXPECT_EQ(refused(*c).where.index, reference);
  }
}

TEST(TableRefusal, LeversInMetresOrKilometres) {
  for (const Vec3& lever : {Vec3(0.25, 0.0, 0.55), Vec3(0, 5001, 0), Vec3(0, 0, -6000)}) {
    auto c = good();
    c->measured.sensed_at_zero = lever;
    EXPECT_EQ(refused(*c).reason, Reason::unit_suspected);
    EXPECT_STREQ(refused(*c).where.field, "L0");
  }
  auto c = good();
  c->measured.sensed_at_zero = Vec3(0, kNan, 0);
  EXPECT_EQ(refused(*c).reason, Reason::not_finite);
  c->measured.sensed_at_zero = Vec3::Zero();  // at the head: a statement, not a mistake
  BuiltTable built;
  EXPECT_TRUE(c->build(built).ok());
}

TEST(TableRefusal, KappaOtherThanMinusOneZeroOne) {
  for (const int kappa : {-2, 2, 100}) {
    auto c = good();
    c->measured.kappa = kappa;
    EXPECT_EQ(refused(*c).reason, Reason::bad_setting);
    EXPECT_STREQ(refused(*c).where.field, "kappa");
  }
}

}  // namespace
}  // namespace volcomp::test
