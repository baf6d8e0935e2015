#include "tests/firmware/node/node_bench.hpp"

#include <algorithm>

#include "comp/core/bytes.hpp"
#include "comp/core/crc32.hpp"
#include "comp/tables/image.hpp"

namespace volcomp::node {
namespace {

constexpr std::size_t kAxisHeader = 54;  // q0, pitch, knots, periodic, direction, expansion
constexpr std::size_t kCrc = 4;

}  // namespace

Bytes image_of(const MachineTables& tables) {
  Bytes bytes(image_size(tables));
  std::size_t written = 0;
  EXPECT_TRUE(encode_image(tables, bytes, written).ok());
  return bytes;
}

std::size_t axis_at(const MachineTables& tables, std::size_t axis) {
  return image_value_offset(tables, axis, 0, 0, 0) - kAxisHeader;
}

void reseal(Bytes& image, const MachineTables& tables) {
  for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
    const std::size_t begin = axis_at(tables, a);
    const std::size_t end = image_value_offset(tables, a, 2, 0, 0);
    store_le(&image[end], kCrc, crc32c({&image[begin], end - begin}));
  }
  const std::size_t end = image.size() - kCrc;
  store_le(&image[end], kCrc, crc32({image.data(), end}));
}

MachineTables bench_tables(std::uint64_t seed) {
  test::Random random(400 + seed);
  MachineTables tables = test::xyfz_tables(3e3, 4e-6, random);
  tables.provenance.machine_id = 1001;
  tables.provenance.sequence = static_cast<std::uint32_t>(seed + 1);
  return tables;
}

hal::CanFrame bench_frame(unsigned id, std::uint8_t size) {
  hal::CanFrame f;
  f.id = static_cast<std::uint16_t>(id);
  f.size = size;
  return f;
}

// --- commissioning

void BenchDevice::configure(std::uint32_t period_us) {
  EXPECT_EQ(set<std::uint32_t>(0x1006, 0, period_us), canopen::AbortCode::none);
  EXPECT_EQ(set<std::uint32_t>(0x2200, 1, 20), canopen::AbortCode::none);
  for (std::uint8_t a = 1; a <= kBenchDrives; ++a)
    EXPECT_EQ(set<std::uint8_t>(0x2010, a, a), canopen::AbortCode::none);
}

void BenchDevice::load(const MachineTables& tables) {
  EXPECT_EQ(write({0x2110, 1}, image_of(tables)), canopen::AbortCode::none);
  EXPECT_EQ(command(TableCommand::activate), canopen::AbortCode::none);
}

bool BenchDevice::emergency(canopen::ErrorCode code, std::uint8_t source) const {
  return std::any_of(emergencies.begin(), emergencies.end(), [&](const BenchEmergency& e) {
    return e.code == static_cast<std::uint16_t>(code) && e.source == source;
  });
}

void BenchDevice::hear(const hal::CanFrame& f, std::uint64_t now_us) {
  if (f.id == canopen::kSdoResponse + kBenchId) client_.response(f.data, now_us);
  if (f.id != canopen::kEmergency + kBenchId) return;
  const auto code = static_cast<std::uint16_t>(load_le(f.data.data(), 2));
  emergencies.push_back({code, f.data[2], f.data[3]});
}

// --- node

NodeBench::NodeBench(Storage* storage) : node(std::make_unique<Node>(kId, storage)) { power_on(); }

void NodeBench::power_on() {
  node->power_on(now_us);
  drain();
}

void NodeBench::give(const hal::CanFrame& f) {
  node->device().receive(f, now_us);
  drain();
}

void NodeBench::wait(std::uint64_t us) {
  constexpr std::uint64_t kStep_us = 100;
  for (const std::uint64_t end = now_us + us; now_us < end;) {
    now_us += kStep_us;
    node->device().poll(now_us);
    drain();
  }
}

void NodeBench::drain() {
  hal::CanFrame f;
  while (node->device().offer(f, now_us) && !port_full) {
    node->device().taken(now_us);
    hear(f, now_us);
    if (f.id != canopen::kSdoResponse + kId) sent.push_back(f);
    for (std::size_t a = 0; a < kDrives; ++a) {
      if (f.id == 0x301U + a) drive[a].next = static_cast<std::int32_t>(load_le(f.data.data(), 4));
    }
  }
}

// --- SDO

canopen::AbortCode NodeBench::finish() {
  canopen::SdoData request{};
  while (client_.state() == canopen::SdoClient::State::busy && client_.request(request))
    give({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request});
  while (client_.request(request))
    give({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request});
  EXPECT_NE(client_.state(), canopen::SdoClient::State::busy);
  return client_.abort_code();
}

canopen::AbortCode NodeBench::write(canopen::ObjectId object, const Bytes& value) {
  client_.download(object, {value.data(), value.size()}, now_us);
  return finish();
}

canopen::AbortCode NodeBench::read(canopen::ObjectId object, Bytes& value) {
  value.assign(kImageCapacity, 0);
  client_.upload(object, {value.data(), value.size()}, now_us);
  const canopen::AbortCode why = finish();
  value.resize(client_.transferred());
  return why;
}

std::uint64_t NodeBench::number(std::uint16_t index, std::uint8_t sub) {
  Bytes value;
  EXPECT_EQ(read({index, sub}, value), canopen::AbortCode::none) << std::hex << index;
  return load_le(value.data(), std::min<std::size_t>(value.size(), 8));
}

std::string NodeBench::text(std::uint16_t index, std::uint8_t sub) {
  Bytes value;
  EXPECT_EQ(read({index, sub}, value), canopen::AbortCode::none) << std::hex << index;
  return {value.begin(), value.end()};
}

// --- life

void NodeBench::configure() {
  EXPECT_EQ(set<std::uint32_t>(0x1006, 0, 0), canopen::AbortCode::none);
  EXPECT_EQ(set<std::uint8_t>(0x1019, 0, 240), canopen::AbortCode::none);
  BenchDevice::configure(kPeriod_us);
}

void NodeBench::nmt(canopen::NmtCommand command) {
  hal::CanFrame f = bench_frame(canopen::kNmt, 2);
  f.data[0] = static_cast<std::uint8_t>(command);
  f.data[1] = kId;
  give(f);
}

void NodeBench::bring_up(const MachineTables& tables) {
  configure();
  load(tables);
  nmt(canopen::NmtCommand::start);
  cycles(60);
  ASSERT_EQ(state(), NodeState::compensating);
  emergencies.clear();
}

// --- cycle

void NodeBench::sync() {
  for (BenchDrive& d : drive) {
    largest_step = std::max(largest_step, std::abs(d.next - d.held));
    d.held = d.next;
  }
  sent.clear();
  counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
  hal::CanFrame f = bench_frame(canopen::kSync, 1);
  f.data[0] = counter_;
  give(f);
}

void NodeBench::drive_data(std::size_t axis) {
  const BenchDrive& d = drive[axis];
  hal::CanFrame f = bench_frame(0x181U + static_cast<unsigned>(axis), 8);
  store_le(f.data.data(), 4, static_cast<std::uint32_t>(d.target + d.held));
  store_le(&f.data[4], 2, d.status);
  give(f);
}

void NodeBench::offset_report(std::size_t axis) {
  hal::CanFrame f = bench_frame(0x481U + static_cast<unsigned>(axis), 4);
  store_le(f.data.data(), 4, static_cast<std::uint32_t>(drive[axis].held));
  give(f);
}

void NodeBench::controller_data(std::size_t axis) {
  hal::CanFrame f = bench_frame(0x201U + static_cast<unsigned>(axis), 6);
  store_le(f.data.data(), 2, 0x0F);
  store_le(&f.data[2], 4, static_cast<std::uint32_t>(drive[axis].target));
  give(f);
}

void NodeBench::cycle() {
  sync();
  for (std::size_t a = 0; a < kDrives; ++a) {
    if (drive[a].silent) continue;
    drive_data(a);
    offset_report(a);
    controller_data(a);
  }
  wait(kPeriod_us);
}

void NodeBench::cycles(int count) {
  for (int i = 0; i < count; ++i)
    cycle();
}

std::array<std::int32_t, NodeBench::kDrives> NodeBench::offsets() const {
  return {drive[0].held, drive[1].held, drive[2].held};
}

}  // namespace volcomp::node
