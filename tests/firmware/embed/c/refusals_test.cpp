// Whatever volcomp.h is given: it reports what is wrong with it, and the tables in use go on.

#include <limits>
#include <set>
#include <string>

#include "tests/firmware/embed/c/support.hpp"
#include "tests/not_numbers.hpp"
#include "tests/oracle/probe_limits.hpp"

namespace volcomp::test {
namespace {

TEST(CInterfaceRefuses, MemoryThatDoesNotServe) {
  const auto memory = std::make_unique<std::array<volcomp_memory, 2>>();
  unsigned char* const bytes = memory->front().bytes;
  volcomp_compensator* c = nullptr;
  EXPECT_EQ(text(volcomp_create(nullptr, VOLCOMP_BYTES, &c)), "null_pointer memory");
  EXPECT_EQ(text(volcomp_create(bytes, VOLCOMP_BYTES, nullptr)), "null_pointer out");
  EXPECT_EQ(text(volcomp_create(bytes, VOLCOMP_BYTES - 1, &c)), "memory_too_small bytes");
  EXPECT_EQ(text(volcomp_create(bytes + 4, VOLCOMP_BYTES, &c)), "memory_misaligned memory");
  EXPECT_EQ(c, nullptr);
  EXPECT_EQ(text(volcomp_create(bytes, VOLCOMP_BYTES, &c)), "ok");
  EXPECT_NE(c, nullptr);
}

TEST(CInterfaceRefuses, NullPointers) {
  const Bytes image = encode(random_l300g(1));
  CInstance c;
  EXPECT_EQ(text(volcomp_stage(nullptr, image.data(), image.size(), nullptr)),
            "null_pointer compensator");
  EXPECT_EQ(text(volcomp_stage(c.get(), nullptr, 4, nullptr)), "null_pointer image");
  EXPECT_EQ(text(volcomp_configure(c.get(), nullptr)), "null_pointer settings");
  EXPECT_EQ(text(volcomp_configure_probe(c.get(), nullptr)), "null_pointer settings");
  EXPECT_EQ(text(volcomp_start_from(c.get(), nullptr)), "null_pointer offset");
  EXPECT_EQ(text(volcomp_activate(nullptr)), "null_pointer compensator");
  EXPECT_EQ(text(volcomp_scrub(nullptr)), "null_pointer compensator");
  volcomp_touch touch{};
  volcomp_feature feature{};
  volcomp_point point{};
  EXPECT_EQ(text(volcomp_correct_touch(c.get(), nullptr, &feature, &point)), "null_pointer touch");
  EXPECT_EQ(text(volcomp_correct_touch(c.get(), &touch, nullptr, &point)), "null_pointer feature");
  EXPECT_EQ(text(volcomp_correct_touch(c.get(), &touch, &feature, nullptr)), "null_pointer out");
}

TEST(CInterfaceRefuses, EveryCallWithoutACompensator) {
  volcomp_settings settings;
  volcomp_default_settings(&settings);
  volcomp_probe_settings probe;
  volcomp_default_probe_settings(&probe);
  const std::array<std::int32_t, VOLCOMP_AXES> held{};
  volcomp_touch touch{};
  volcomp_feature feature{};
  volcomp_point point{};
  const std::string expected = "null_pointer compensator";
  EXPECT_EQ(text(volcomp_configure(nullptr, &settings)), expected);
  EXPECT_EQ(text(volcomp_configure_probe(nullptr, &probe)), expected);
  EXPECT_EQ(text(volcomp_start_from(nullptr, held.data())), expected);
  EXPECT_EQ(text(volcomp_correct_touch(nullptr, &touch, &feature, &point)), expected);
}

TEST(CInterfaceRefuses, SettingsOutOfRangeByName) {
  CInstance c;
  volcomp_settings s;
  const auto with = [&](auto change) {
    volcomp_default_settings(&s);
    change(s);
    return text(volcomp_configure(c.get(), &s));
  };
  EXPECT_EQ(with([](volcomp_settings&) {}), "ok");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].limit = 0; }), "bad_setting limit");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].rate = 2'000'000'000; }), "bad_setting rate");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].soft_rate = 20'000; }),
            "bad_setting soft_rate");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].hysteresis = -1; }), "bad_setting hysteresis");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].max_step = -1; }), "bad_setting max_step");
  EXPECT_EQ(with([](volcomp_settings& x) { x.axis[1].acceleration = -1; }),
            "bad_setting acceleration");
  EXPECT_EQ(with([](volcomp_settings& x) { x.ramp_ticks = 0; }), "bad_setting ramp_ticks");
  EXPECT_EQ(with([](volcomp_settings& x) { x.positions = 2; }), "bad_setting positions");
  volcomp_default_settings(&s);
  s.axis[3].limit = 0;
  EXPECT_EQ(volcomp_configure(c.get(), &s).index, 3);
}

TEST(CInterfaceSettings, NoOffsetChangesItsStepByMoreThanItsAcceleration) {
  Random random(7);
  CInstance c;
  const MachineTables tables = random_l300g(3);
  ASSERT_EQ(c.stage(encode(tables)).reason, VOLCOMP_OK);
  volcomp_settings s;
  volcomp_default_settings(&s);
  EXPECT_EQ(s.axis[0].acceleration, 0);
  constexpr std::int32_t kAcceleration = 50;
  for (volcomp_axis_limits& l : s.axis)
    l.acceleration = kAcceleration;
  ASSERT_EQ(volcomp_configure(c.get(), &s).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
  std::array<std::int64_t, kMaxAxes> q = random_probing_pose(random);
  std::int32_t before = 0;
  std::int32_t step = 0;
  std::int32_t limited = 0;
  for (int n = 0; n < 5'000; ++n) {
    if (n % 700 == 0) q = random_probing_pose(random);
    const volcomp_output& out = c.tick(q);
    const std::int32_t moved = out.offset[0] - before;
    ASSERT_LE(std::abs(moved - step), kAcceleration) << n;
    before = out.offset[0];
    step = moved;
    if ((out.status[0] & VOLCOMP_ACCELERATION_LIMITED) != 0) ++limited;
  }
  volcomp_diagnostics d;
  volcomp_diagnose(c.get(), &d);
  EXPECT_GT(limited, 0);
  EXPECT_GT(d.began[0][14], 0);
  EXPECT_GT(d.largest_lag[0], kAcceleration);
}

TEST(CInterfaceRefuses, ImagesAndKeepsTheTablesInUse) {
  const MachineTables tables = random_l300g(2);
  const Bytes good = encode(tables);
  CInstance c;
  EXPECT_EQ(text(volcomp_activate(c.get())), "not_staged");
  c.start(tables);
  Random random(3);
  const auto q = random_probing_pose(random);
  c.tick(q);
  const std::int32_t before = c.tick(q).offset[0];
  ASSERT_NE(before, 0);

  Bytes bad = good;
  bad[0] = 'X';
  EXPECT_EQ(text(c.stage(bad)), "bad_magic");
  bad = good;
  bad.pop_back();
  EXPECT_EQ(text(c.stage(bad)), "image_truncated");
  bad = good;
  bad[bad.size() / 2] ^= 1U;
  EXPECT_EQ(text(c.stage(bad)), "crc_mismatch");
  MachineTables other = tables;
  other.axis[2].value[1][4][5] = std::numeric_limits<float>::infinity();
  const volcomp_status status = c.stage(encode(other));
  EXPECT_EQ(text(status), "not_finite");
  EXPECT_EQ(status.axis, 'B');
  EXPECT_EQ(status.index, 4);
  EXPECT_EQ(status.channel, 5);
  EXPECT_EQ(text(c.stage(encode(xyfz_tables(1e3, 1e-5, random)))), "axes_mismatch");
  other = tables;
  other.machine.body[1].joint.offset[0] += 1.0;
  EXPECT_EQ(text(c.stage(encode(other))), "machine_mismatch");
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> tool{};
    tool.at(i) = kNan;
    EXPECT_EQ(text(c.stage(good, tool.data())), "not_finite tool") << i;
  }

  // Nothing of all this can be activated.
  EXPECT_EQ(text(volcomp_activate(c.get())), "not_staged");
  EXPECT_TRUE(volcomp_active(c.get()));
  EXPECT_EQ(c.tick(q).offset[0], before);
  volcomp_diagnostics d;
  volcomp_diagnose(c.get(), &d);
  EXPECT_EQ(d.rejections, 6U);
  EXPECT_EQ(text(d.last_rejection), "machine_mismatch");
  EXPECT_EQ(d.active_crc, image_crc({good.data(), good.size()}));
  volcomp_machine m;
  volcomp_describe(c.get(), &m);
  EXPECT_EQ(m.image_crc, d.active_crc);
}

// Before anything was active, another machine may still come, but only with tables that can be
// used: the offsets that the drives hold are not forgotten for others.
TEST(CInterfaceRefuses, AnotherMachineThatCannotBeUsed) {
  constexpr std::uint32_t kOurs = 7;
  MachineTables tables = random_l300g(4);
  tables.provenance.machine_id = kOurs;
  const Bytes good = encode(tables);
  const std::array<std::int32_t, VOLCOMP_AXES> held{5000, 0, 0, 0, 0};
  const auto first_offset = [&](bool disturbed) {
    CInstance c;
    volcomp_settings s;
    volcomp_default_settings(&s);
    s.machine_id = kOurs;
    EXPECT_EQ(volcomp_configure(c.get(), &s).reason, VOLCOMP_OK);
    EXPECT_EQ(c.stage(good).reason, VOLCOMP_OK);
    EXPECT_EQ(volcomp_start_from(c.get(), held.data()).reason, VOLCOMP_OK);
    if (disturbed) {
      Random random(1);
      MachineTables other = xyfz_tables(1e3, 1e-5, random);
      other.provenance.machine_id = kOurs + 1;
      EXPECT_EQ(text(c.stage(encode(other))), "machine_mismatch");
      other.provenance.machine_id = kOurs;
      other.axis[0].value[0][3][0] = 1e9F;
      EXPECT_EQ(text(c.stage(encode(other))), "bound_exceeded");
      EXPECT_EQ(c.stage(good).reason, VOLCOMP_OK);
    }
    EXPECT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
    return c.tick({}).offset[0];
  };
  EXPECT_EQ(first_offset(true), first_offset(false));
}

// A good image that was staged does not survive a bad one: what would be activated is unclear.
TEST(CInterfaceRefuses, ActivationAfterABadImage) {
  const Bytes good = encode(random_l300g(4));
  CInstance c;
  ASSERT_EQ(c.stage(good).reason, VOLCOMP_OK);
  EXPECT_EQ(text(c.stage({1, 2, 3})), "bad_magic");
  EXPECT_EQ(text(volcomp_activate(c.get())), "not_staged");
}

// The machine is not fixed yet: the same tables may be given twice, others too.
TEST(CInterfaceStart, TablesMayBeGivenTwiceBeforeTheyAreActivated) {
  const Bytes image = encode(random_l300g(13));
  CInstance c;
  ASSERT_EQ(c.stage(image).reason, VOLCOMP_OK);
  ASSERT_EQ(c.stage(image).reason, VOLCOMP_OK);
  EXPECT_EQ(text(volcomp_activate(c.get())), "ok");
  EXPECT_EQ(text(volcomp_activate(c.get())), "not_staged");
}

// Axes that a compensator of five has no room for.
TEST(CInterfaceRefuses, AMachineOfSixAxes) {
  MachineTables six = random_l300g(14);
  const std::size_t first = six.machine.body_count;
  std::uint8_t axes = 0;
  for (std::size_t k = 0; k < first; ++k)
    axes = static_cast<std::uint8_t>(axes + (six.machine.body[k].joint.moves() ? 1 : 0));
  for (; axes < 6; ++axes) {
    six.axis[axes] = six.axis[0];
    Body& body = six.machine.body[six.machine.body_count];
    body.lower = six.machine.tool_body;
    body.joint = {JointKind::prismatic, Axis::z, 1, Branch::tool, axes, 'W'};
    six.machine.tool_body = ++six.machine.body_count;
  }
  CInstance c;
  EXPECT_EQ(text(c.stage(encode(six))), "too_many_axes");
  EXPECT_EQ(text(volcomp_activate(c.get())), "not_staged");
  EXPECT_EQ(volcomp_direction(c.get(), VOLCOMP_AXES), VOLCOMP_UNKNOWN);
}

// Before the first activation the machine is open; afterwards changes wait for the tick.
TEST(CInterfaceRefuses, ChangesWhileOneIsPending) {
  Random random(5);
  const MachineTables tables = random_l300g(6);
  CInstance c;
  ASSERT_EQ(c.stage(encode(xyfz_tables(1e3, 1e-5, random))).reason, VOLCOMP_OK);
  volcomp_machine m;
  volcomp_describe(c.get(), &m);
  EXPECT_STREQ(m.letter, "XYZ");
  c.start(tables);
  volcomp_describe(c.get(), &m);
  EXPECT_STREQ(m.letter, "XYBA");
  EXPECT_EQ(m.axes, 4U);
  EXPECT_TRUE(!m.rotary[1] && m.rotary[2] && m.corrects[2] && !m.corrects[3]);
  EXPECT_TRUE(volcomp_pending(c.get()));
  EXPECT_EQ(text(c.stage(encode(tables))), "hand_over_pending");
  volcomp_touch touch{};
  volcomp_feature feature{};
  volcomp_point point;
  EXPECT_EQ(text(volcomp_correct_touch(c.get(), &touch, &feature, &point)), "hand_over_pending");
  c.tick(random_probing_pose(random));
  EXPECT_EQ(text(volcomp_correct_touch(c.get(), &touch, &feature, &point)), "ok");
}

TEST(CInterfaceRefuses, SettingsOfTheProbeByName) {
  CInstance c;
  volcomp_probe_settings s;
  const auto with = [&](auto change) {
    volcomp_default_probe_settings(&s);
    change(s);
    return text(volcomp_configure_probe(c.get(), &s));
  };
  using Settings = volcomp_probe_settings;
  EXPECT_EQ(with([](Settings&) {}), "ok");
  EXPECT_EQ(with([](Settings& x) { x.delay_s = 0.06; }), "bad_setting delay");
  EXPECT_EQ(with([](Settings& x) { x.latch_delay_s[4] = 0.06; }), "bad_setting latch delay");
  EXPECT_EQ(with([](Settings& x) { x.radius[7] = kNan; }), "not_finite radius");
  EXPECT_EQ(with([](Settings& x) { x.radius[0] = -1.0; }), "bad_setting radius");
  EXPECT_EQ(with([](Settings& x) { x.radius[3] = 2.1e7; }), "bad_setting radius");
  EXPECT_EQ(with([](Settings& x) { x.rotation[0] = kNan; }), "not_finite rotation");
  EXPECT_EQ(with([](Settings& x) { x.rotation[0] = -1.0; }), "not_a_rotation rotation");
  EXPECT_EQ(with([](Settings& x) { x.translation[2] = kNan; }), "not_finite translation");
  EXPECT_EQ(with([](Settings& x) { x.translation[2] = 1e14; }), "bad_setting translation");
  const std::string nowhere = "not_finite uncertainty";
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.normal = kNan; }), nowhere);
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.position[1] = kNan; }), nowhere);
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.latch_delay_s[4] = kNan; }), nowhere);
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.correlation = 1.1; }), "bad_setting correlation");
  const std::string beyond = "bad_setting uncertainty";
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.radius = 1e300; }), beyond);
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.position[3] = 1e300; }), beyond);
  EXPECT_EQ(with([](Settings& x) { x.uncertainty.latch_delay_s[0] = -1e300; }), beyond);
}

// The field of volcomp.h that an object of the node sets.
double& field_of(volcomp_probe_settings& s, std::uint16_t index, std::size_t sub) {
  volcomp_probe_uncertainty& u = s.uncertainty;
  const std::array<double*, 7> single{&u.radius, &u.tool_length, &u.correlation, &u.repeatability,
                                      &u.tables, &u.normal,      &u.delay_s};
  switch (index) {
    case 0x2302:
      return s.radius[sub - 1];
    case 0x2303:
      return sub <= 9 ? s.rotation[sub - 1] : s.translation[sub - 10];
    case 0x2304:
      return *single.at(sub - 1);
    case 0x2305:
      return u.position[sub - 1];
    default:
      return u.latch_delay_s[sub - 1];
  }
}

TEST(CInterfaceRefuses, TheSameSettingsOfTheProbeAsTheNode) {
  CInstance c;
  for (const oracle::ProbeSettingCase& bad : oracle::probe_setting_cases()) {
    SCOPED_TRACE(::testing::Message()
                 << std::hex << bad.index << ":" << unsigned{bad.sub} << " " << bad.wrong);
    volcomp_probe_settings s;
    volcomp_default_probe_settings(&s);
    const bool delay = bad.index == 0x2306 || (bad.index == 0x2304 && bad.sub == 7);
    const double unit = delay ? 1e-9 : 1.0;  // ns on the bus, s in C
    field_of(s, bad.index, bad.sub) = bad.wrong * unit;
    EXPECT_EQ(volcomp_configure_probe(c.get(), &s).reason, static_cast<int>(bad.reason));
    field_of(s, bad.index, bad.sub) = bad.right * unit;
    EXPECT_EQ(volcomp_configure_probe(c.get(), &s).reason, VOLCOMP_OK);
  }
  for (const bool latch : {false, true}) {
    volcomp_probe_settings s;
    volcomp_default_probe_settings(&s);
    double& delay_s = latch ? s.latch_delay_s[4] : s.delay_s;
    delay_s = 1e-9 * oracle::kLongestProbeDelay_ns;
    EXPECT_EQ(volcomp_configure_probe(c.get(), &s).reason, VOLCOMP_OK);
    delay_s = 1e-9 * (oracle::kLongestProbeDelay_ns + 1.0);
    EXPECT_EQ(volcomp_configure_probe(c.get(), &s).reason, VOLCOMP_BAD_SETTING);
    delay_s = -1e-9;
    EXPECT_EQ(volcomp_configure_probe(c.get(), &s).reason, VOLCOMP_BAD_SETTING);
  }
}

TEST(CInterfaceRefuses, TouchesByName) {
  CInstance c;
  volcomp_touch touch{};
  volcomp_feature feature{};
  volcomp_point point;
  const auto correct = [&] {
    return text(volcomp_correct_touch(c.get(), &touch, &feature, &point));
  };
  EXPECT_EQ(correct(), "ok");
  EXPECT_EQ(point.verdict, VOLCOMP_NO_MACHINE);
  c.start(random_l300g(7));
  Random random(8);
  c.tick(random_probing_pose(random));
  touch.axis[1].velocity = kNan;
  EXPECT_EQ(correct(), "not_finite velocity");
  touch.axis[1].velocity = 1e14;
  EXPECT_EQ(correct(), "bad_setting velocity");
  touch.axis[1].velocity = 0.0;
  touch.axis[3].direction = 3;
  EXPECT_EQ(correct(), "bad_setting direction");
  touch.axis[3].direction = -1;
  EXPECT_EQ(correct(), "bad_setting direction");
  touch.axis[3].direction = VOLCOMP_UNKNOWN;
  feature.normal[0] = 0.5;
  EXPECT_EQ(correct(), "bad_setting normal");
  feature.normal[0] = kNan;
  EXPECT_EQ(correct(), "not_finite normal");
  feature.normal[0] = 0.0;
  for (volcomp_latch& latch : touch.axis)
    latch.position = std::numeric_limits<std::int64_t>::min();  // held at the tables' ends
  EXPECT_EQ(correct(), "ok");
  EXPECT_EQ(point.verdict, VOLCOMP_UNCERTIFIED);
  volcomp_deactivate(c.get());
  c.tick(random_probing_pose(random));
  EXPECT_EQ(correct(), "ok");
  EXPECT_EQ(point.verdict, VOLCOMP_UNCORRECTED);
}

// A point of a linear machine moves as far as its axes: by 10 km, where positions are held, and
// what the fastest axis does in the longest delays. Everything accepted, nothing out of range.
TEST(CInterfaceProbe, TheFurthestPointIsANumber) {
  Random random(15);
  CInstance c;
  c.start(xyfz_tables(1e3, 1e-5, random));
  c.tick({});
  volcomp_probe_settings s;
  volcomp_default_probe_settings(&s);
  s.delay_s = 0.05;
  for (double& delay_s : s.latch_delay_s)
    delay_s = 0.05;
  for (double& t : s.translation)
    t = -1e13;
  const std::array<double, 3> tool_mm{5000.0, -5000.0, 5000.0};
  ASSERT_EQ(c.stage(encode(xyfz_tables(1e3, 1e-5, random)), tool_mm.data()).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
  c.tick({});
  ASSERT_EQ(volcomp_configure_probe(c.get(), &s).reason, VOLCOMP_OK);
  const volcomp_feature feature{};  // the centre of the ball: no direction is retracting
  volcomp_touch touch{};
  volcomp_point near;
  ASSERT_EQ(volcomp_correct_touch(c.get(), &touch, &feature, &near).reason, VOLCOMP_OK);
  for (const double sense : {-1.0, 1.0}) {
    for (std::size_t a = 0; a < 3; ++a)
      touch.axis[a] = {sense < 0.0 ? INT64_MIN : INT64_MAX, -sense * 1e13, VOLCOMP_UNKNOWN};
    volcomp_point far;
    ASSERT_EQ(volcomp_correct_touch(c.get(), &touch, &feature, &far).reason, VOLCOMP_OK);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::abs(static_cast<double>(far.workpiece[k] - near.workpiece[k])), 1.1e13, 1e7);
      EXPECT_TRUE(std::isfinite(far.uncertainty[k]));
    }
  }
}

// A drive that holds an offset is led from there, not jumped to 0.
TEST(CInterfaceStart, GoesOnFromTheOffsetsOfTheDrives) {
  const Bytes image = encode(random_l300g(9));
  std::array<std::int32_t, VOLCOMP_AXES> held{90'000, -80'000, 70'000, 0, 0};
  CInstance c;
  ASSERT_EQ(c.stage(image).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_start_from(c.get(), held.data()).reason, VOLCOMP_OK);
  ASSERT_EQ(volcomp_activate(c.get()).reason, VOLCOMP_OK);
  Random random(10);
  const auto q = random_probing_pose(random);
  volcomp_settings defaults;
  volcomp_default_settings(&defaults);
  for (int n = 0; n < 400; ++n) {
    const volcomp_output& out = c.tick(q);
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_LE(std::abs(out.offset[a] - held[a]), defaults.axis[a].rate) << "tick " << n;
      held[a] = out.offset[a];
    }
  }
  held[1] = 1'073'741'825;
  EXPECT_EQ(text(volcomp_start_from(c.get(), held.data())), "bad_setting start offset");
}

// One bit of the memory in which the active tables lie.
TEST(CInterfaceScrub, FindsABitThatChanged) {
  CInstance c;
  c.start(random_l300g(11));
  Random random(12);
  const auto q = random_probing_pose(random);
  c.tick(q);
  ASSERT_NE(c.tick(q).offset[0], 0);
  EXPECT_EQ(text(volcomp_scrub(c.get())), "ok");
  c.bytes()[30'000] ^= 4U;
  EXPECT_EQ(text(volcomp_scrub(c.get())), "crc_mismatch");
  c.tick(q);
  const volcomp_output& out = c.tick(q);
  EXPECT_EQ(out.offset[0], 0);
  EXPECT_NE(out.status[0] & VOLCOMP_TABLE_DAMAGED, 0);
}

TEST(CInterfaceText, EveryNumberHasAName) {
  std::set<std::string> names;
  for (int reason = -2; reason < 300; ++reason) {
    const std::string code = volcomp_code(reason);
    ASSERT_FALSE(std::string(volcomp_sentence(reason)).empty());
    EXPECT_TRUE(code == "unknown" || names.insert(code).second) << code;
  }
  EXPECT_EQ(names.count("memory_misaligned"), 1U);
  EXPECT_EQ(names.count("hand_over_pending"), 1U);
  EXPECT_STREQ(volcomp_sentence(VOLCOMP_CRC_MISMATCH),
               "The checksum is wrong; the image is damaged.");
  names.clear();
  for (unsigned bit = 0; bit < VOLCOMP_STATUS_BITS; ++bit) {
    EXPECT_TRUE(names.insert(volcomp_status_code(1U << bit)).second);
    EXPECT_STRNE(volcomp_status_words(1U << bit), "unknown");
  }
  EXPECT_STREQ(volcomp_status_code(VOLCOMP_CLAMPED | VOLCOMP_RAMPING), "clamped");
  EXPECT_STREQ(volcomp_status_code(0), "unknown");
  EXPECT_STREQ(volcomp_status_words(1U << VOLCOMP_STATUS_BITS), "unknown");
  EXPECT_STREQ(volcomp_verdict_code(VOLCOMP_RETRACTING), "retracting");
  EXPECT_STREQ(volcomp_verdict_code(VOLCOMP_NO_MACHINE), "no_machine");
  EXPECT_STRNE(volcomp_verdict_sentence(VOLCOMP_NO_MACHINE), "unknown");
  for (const int verdict : {-1, 15}) {
    EXPECT_STREQ(volcomp_verdict_code(verdict), "unknown");
    EXPECT_STREQ(volcomp_verdict_sentence(verdict), "unknown");
  }
}

}  // namespace
}  // namespace volcomp::test
