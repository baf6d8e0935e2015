#include "tests/host_sim/sim/drives/cia402_bench.hpp"

#include <algorithm>

#include "comp/core/bytes.hpp"

namespace volcomp::sim {
namespace {

// Shutdown, switch on, enable operation; then the first target to follow.
constexpr std::array<std::uint16_t, 4> kWayUp{0x06, 0x07, 0x0F, 0x0F};

std::vector<std::uint8_t> little_endian(std::uint64_t value, std::size_t bytes) {
  std::vector<std::uint8_t> out(bytes);
  store_le(out.data(), bytes, value);
  return out;
}

std::uint32_t payload(const hal::CanFrame& response) {
  return static_cast<std::uint32_t>(load_le(&response.data[4], 4));
}

}  // namespace

hal::CanFrame frame(std::uint16_t id, const std::vector<std::uint8_t>& bytes) {
  hal::CanFrame f;
  f.id = id;
  f.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), f.data.begin());
  return f;
}

Cia402Drive::Settings Bench::node_three() {
  Cia402Drive::Settings settings;
  settings.node_id = kNode;
  return settings;
}

Cia402Drive::Settings Bench::rotary() {
  Cia402Drive::Settings settings = node_three();
  settings.rotary = true;
  return settings;
}

Bench::Bench(const Cia402Drive::Settings& settings) : drive(settings) {
  drive.power_on(now_us);
  collect();
}

void Bench::collect() {
  drive.poll(now_us);
  hal::CanFrame f;
  while (drive.offer(f, now_us)) {
    sent.push_back(f);
    if (f.id == 0x080 + kNode) emergencies.push_back(f);
    drive.taken(now_us);
  }
}

void Bench::give(std::uint16_t id, const std::vector<std::uint8_t>& bytes) {
  drive.receive(frame(id, bytes), now_us);
  collect();
}

void Bench::wait(std::uint64_t us) {
  for (const std::uint64_t end = now_us + us; now_us < end;) {
    now_us = std::min<std::uint64_t>(now_us + 100, end);
    collect();
  }
}

void Bench::command(std::uint16_t controlword, std::int32_t target) {
  std::vector<std::uint8_t> bytes = little_endian(controlword, 2);
  for (const std::uint8_t byte : little_endian(static_cast<std::uint32_t>(target), 4))
    bytes.push_back(byte);
  give(0x200 + kNode, bytes);
}

void Bench::offset(std::int32_t units) {
  give(0x300 + kNode, little_endian(static_cast<std::uint32_t>(units), 4));
}

void Bench::sync() {
  if (now_us < last_sync_us_ + kPeriod_us) wait(last_sync_us_ + kPeriod_us - now_us);
  sent.clear();
  last_sync_us_ = now_us;
  give(0x080, {});
}

void Bench::cycle(std::uint16_t controlword, std::int32_t target) {
  command(controlword, target);
  sync();
}

void Bench::enable(std::int32_t target) {
  start_node();
  for (const std::uint16_t controlword : kWayUp)
    cycle(controlword, target);
}

std::uint32_t Bench::write(std::uint16_t index, std::uint8_t sub, std::int64_t value,
                           std::size_t bytes) {
  const auto specifier = static_cast<std::uint8_t>(0x23U | (4U - bytes) << 2U);
  std::vector<std::uint8_t> request{specifier, static_cast<std::uint8_t>(index),
                                    static_cast<std::uint8_t>(index >> 8U), sub};
  const std::uint64_t mask = (std::uint64_t{1} << (8U * bytes)) - 1U;
  for (const std::uint8_t byte : little_endian(static_cast<std::uint64_t>(value) & mask, 4))
    request.push_back(byte);
  sent.clear();
  give(0x600 + kNode, request);
  const hal::CanFrame response = find(0x580 + kNode);
  return response.data[0] == 0x60 ? 0U : payload(response);
}

std::uint32_t Bench::read(std::uint16_t index, std::uint8_t sub) {
  sent.clear();
  give(0x600 + kNode, {0x40, static_cast<std::uint8_t>(index),
                       static_cast<std::uint8_t>(index >> 8U), sub, 0, 0, 0, 0});
  return payload(find(0x580 + kNode));
}

hal::CanFrame Bench::find(std::uint16_t id) const {
  const auto at =
      std::find_if(sent.begin(), sent.end(), [id](const hal::CanFrame& f) { return f.id == id; });
  return at == sent.end() ? hal::CanFrame{} : *at;
}

std::size_t Bench::count(std::uint16_t id) const {
  return static_cast<std::size_t>(
      std::count_if(sent.begin(), sent.end(), [id](const hal::CanFrame& f) { return f.id == id; }));
}

}  // namespace volcomp::sim
