#include "tests/firmware/node/strokes/stroke_bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace volcomp::node {

namespace {

constexpr double kPerTurn = 2147483648.0;  // drive units
constexpr double kUnitsPerRad = kPerTurn / (2.0 * kPi);

Bytes real_bytes(double value) {
  Bytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <class T>
std::vector<T> values_of(const Bytes& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace

MachineTables stroke_tables() {
  MachineTables t;
  t.provenance.machine_id = 1003;
  t.provenance.sequence = 1;
  t.machine.body[1] = test::moving_body(1, JointKind::prismatic, Axis::x, 1, 0, 'X');
  t.machine.body[2] = test::moving_body(2, JointKind::rotary, Axis::z, 1, 2, 'C');
  t.machine.body[3] = test::moving_body(1, JointKind::prismatic, Axis::z, 1, 1, 'Z');
  t.machine.body_count = 4;
  t.machine.work_body = 3;
  t.machine.tool_body = 4;
  t.machine.tool_point = {80.0, 0.0, 0.0};
  t.machine.correcting = {2};
  t.machine.correcting_count = 1;
  for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
    t.axis[a].q0 = -100'000'000;
    t.axis[a].pitch = 100'000'000;
    t.axis[a].knots = 3;
  }
  t.axis[2].q0 = 0;
  t.axis[2].pitch = kUnitsPerTurn / 4;
  t.axis[2].knots = 4;
  t.axis[2].periodic = true;
  return t;
}

void StrokeBench::configure() {
  bench.configure();
  const auto set = [this](std::uint16_t index, std::uint8_t sub, auto value) {
    EXPECT_EQ(bench.set(index, sub, value), canopen::AbortCode::none) << std::hex << index;
  };
  set(0x2030, 3, std::uint32_t{512});  // 2^31 units per turn of C
  set(0x2032, 3, std::uint8_t{1});
  set(0x2202, 3, std::int32_t{140'000});
  for (std::uint8_t i = 0; i < 3; ++i)
    set(0x2500, static_cast<std::uint8_t>(2 + i), static_cast<std::uint8_t>(1 + i));
  set(0x2500, 5, kSlots);
  set(0x2500, 6, std::uint16_t{11});
  set(0x2500, 7, std::uint32_t{1'000'000});
  set(0x2500, 8, -std::int64_t{kHalfFace_nm});
  const std::array<double, 3> gear{kTurnPerMm, kLever, 0.3246};
  for (std::uint8_t i = 0; i < 3; ++i)
    EXPECT_EQ(bench.write({0x2501, static_cast<std::uint8_t>(1 + i)}, real_bytes(gear.at(i))),
              canopen::AbortCode::none);
}

void StrokeBench::start() {
  EXPECT_EQ(bench.set<std::uint8_t>(0x2500, 1, 1), canopen::AbortCode::none);
  bench.load(stroke_tables());
  bench.nmt(canopen::NmtCommand::start);
  for (int i = 0; i < 60; ++i)
    cycle(now_.z, 0, true, false, {});
  ASSERT_EQ(bench.state(), NodeState::compensating);
}

void StrokeBench::note_step() {
  const std::int32_t step = bench.drive[2].held - held_;
  largest_change = std::max(largest_change, std::abs(step - step_));
  held_ = bench.drive[2].held;
  step_ = step;
}

void StrokeBench::cycle(std::int32_t z_nm, std::uint16_t slot, bool up, bool end,
                        const ErrorsAt& errors) {
  bench.sync();
  note_step();
  const double z_mm = now_.z * 1e-6;
  const Errors e = errors ? errors(now_.slot, now_.up, z_mm) : Errors{};
  auto& drive = bench.drive;
  drive[0].target = 44'000'000;
  drive[1].target = now_.z + static_cast<std::int32_t>(std::lround(e.z_mm * 1e6));
  drive[2].target = now_.c + static_cast<std::int32_t>(std::lround(e.c_rad * kUnitsPerRad));
  if (now_.in_face) {
    most = std::max(most, offset());
    least = std::min(least, offset());
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (drive[a].silent) continue;
    bench.drive_data(a);
    bench.offset_report(a);
  }
  now_ = {z_nm, static_cast<std::int32_t>(std::lround(-z_nm * 1e-6 * kTurnPerMm * kUnitsPerRad)),
          slot, up, std::abs(z_nm) <= kHalfFace_nm};
  drive[1].target = now_.z;
  drive[2].target = now_.c;
  const bool lost = process_state_lost && process_state_lost(slot, up, z_nm * 1e-6);
  if (!lost) {
    hal::CanFrame f = bench_frame(0x1FF, 8);
    store_le(f.data.data(), 2, slot);
    const unsigned flags = (now_.in_face ? kInFace : 0U) | (end ? kStrokeEnd : 0U) |
                           (up ? kStrokeForward : kStrokeBackward);
    store_le(&f.data[2], 2, flags);
    store_le(&f.data[4], 4, static_cast<std::uint32_t>(feed_nm_per_s));
    bench.give(f);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (!drive[a].silent) bench.controller_data(a);
  }
  bench.wait(NodeBench::kPeriod_us);
}

void StrokeBench::stroke(std::uint16_t slot, bool up, const ErrorsAt& errors) {
  constexpr std::int32_t kEnd_nm = 6'000'000;
  const std::int32_t sign = up ? 1 : -1;
  cycle(-sign * kEnd_nm, slot, up, true, errors);
  for (std::int32_t way = -kEnd_nm; way <= kEnd_nm; way += kStep_nm)
    cycle(sign * way, slot, up, false, errors);
}

void StrokeBench::grind(const ErrorsAt& errors, int rounds) {
  for (int i = 0; i < rounds; ++i) {
    most = -1.0;
    least = 1.0;
    for (std::uint16_t slot = 0; slot < kSlots; ++slot) {
      stroke(slot, true, errors);
      stroke(slot, false, errors);
    }
  }
}

double StrokeBench::offset() const { return bench.drive[2].held / kUnitsPerRad; }

std::array<float, 3> StrokeBench::floats(std::uint16_t index) {
  std::array<float, 3> all{};
  for (std::uint8_t i = 0; i < 3; ++i) {
    Bytes bytes;
    EXPECT_EQ(bench.read({index, static_cast<std::uint8_t>(i + 1)}, bytes),
              canopen::AbortCode::none);
    all.at(i) = values_of<float>(bytes).at(0);
  }
  return all;
}

double StrokeBench::real(std::uint16_t index, std::uint8_t sub) {
  Bytes bytes;
  EXPECT_EQ(bench.read({index, sub}, bytes), canopen::AbortCode::none);
  return values_of<double>(bytes).at(0);
}

std::vector<float> StrokeBench::means(std::uint8_t table) {
  Bytes bytes;
  EXPECT_EQ(bench.read({0x2516, table}, bytes), canopen::AbortCode::none);
  return values_of<float>(bytes);
}

Bytes StrokeBench::image() {
  Bytes bytes;
  EXPECT_EQ(bench.read({0x2526, 1}, bytes), canopen::AbortCode::none);
  return bytes;
}

}  // namespace volcomp::node
