#include "tests/firmware/canopen/test_device.hpp"

#include <algorithm>
#include <cstddef>

#include "comp/core/bytes.hpp"
#include "firmware/canopen/device.inl"

namespace volcomp::canopen::test {
namespace {

#define TEST_AT(member) static_cast<std::uint16_t>(offsetof(TestObjects, member))

constexpr std::array<NamedEntry, 12> kOwnEntries{{
    {0x2000, 0, 0, DataType::unsigned16, Access::read_write, kPlain, TEST_AT(word), 0, "Word", 10,
     1000},
    {0x2001, 0, 0, DataType::integer8, Access::read_write, kPlain, TEST_AT(small), 0, "Small", -5,
     5},
    {0x2002, 1, 4, DataType::unsigned32, Access::read_write, kPlain, TEST_AT(list), 0, "List"},
    {0x2003, 0, 0, DataType::visible_string, Access::read_write, kPlain, TEST_AT(text), 8, "Text"},
    {0x2004, 0, 0, DataType::unsigned8, Access::write_only, kPlain, TEST_AT(secret), 0, "Secret"},
    {0x2005, 0, 0, DataType::unsigned64, Access::read_only, kTransmit, TEST_AT(wide), 0, "Wide"},
    {0x2006, 0, 0, DataType::integer16, Access::constant, kPlain, TEST_AT(fixed), 0, "Fixed"},
    {0x2010, 0, 0, DataType::domain, Access::read_write, kPlain, 0, 0, "Domain"},
    {0x6040, 0, 0, DataType::unsigned16, Access::read_write, kReceive, TEST_AT(control), 0,
     "Controlword"},
    {0x6041, 0, 0, DataType::unsigned16, Access::read_only, kTransmit, TEST_AT(status), 0,
     "Statusword"},
    {0x6064, 0, 0, DataType::integer32, Access::read_only, kTransmit, TEST_AT(actual), 0,
     "Position actual value"},
    {0x607A, 0, 0, DataType::integer32, Access::read_write, kReceive, TEST_AT(target), 0,
     "Target position"},
}};

#undef TEST_AT

constexpr auto kNamed = with_communication(kOwnEntries);

SdoData sdo(std::uint8_t command, ObjectId object, std::uint32_t value = 0) {
  SdoData data{command};
  store_le(&data[1], 2, object.index);
  data[3] = object.sub;
  store_le(&data[4], 4, value);
  return data;
}

}  // namespace

hal::CanFrame frame(std::uint16_t id, const std::vector<unsigned>& bytes) {
  hal::CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::transform(bytes.begin(), bytes.end(), frame.data.begin(),
                 [](unsigned byte) { return static_cast<std::uint8_t>(byte); });
  return frame;
}

// --- TestApplication

void TestApplication::reset_communication() {
  resets.emplace_back("communication");
  objects.communication = {};
  objects.communication.device_type = 0x0002'0192;
  objects.communication.vendor_id = 0x11;
  objects.communication.product_code = 0x22;
  objects.communication.revision = 0x33;
  objects.communication.serial_number = 0x44;
  objects.communication.device_name = {'t', 'e', 's', 't'};
}

void TestApplication::state_changed(NmtState state, std::uint64_t) { states.push_back(state); }

void TestApplication::sync(std::uint8_t counter, std::uint64_t) {
  sync_counters.push_back(counter);
  target_at_sync.push_back(objects.target);
}

void TestApplication::received(const Pdo& pdo, std::uint64_t) { received_ids.push_back(pdo.id()); }

bool TestApplication::heartbeat(std::uint8_t node, HeartbeatEvent event, std::uint64_t) {
  heartbeats.push_back({node, event});
  return loss_is_error;
}

void TestApplication::bad_sync(SyncVerdict verdict, std::uint64_t) { bad_syncs.push_back(verdict); }

AbortCode TestApplication::read_domain(ObjectId, Span<const std::uint8_t>& source) {
  source = {domain.data(), domain_size};
  return AbortCode::none;
}

AbortCode TestApplication::begin_domain(ObjectId, std::size_t, Span<std::uint8_t>& sink) {
  sink = {domain.data(), domain.size()};
  return AbortCode::none;
}

AbortCode TestApplication::finish_domain(ObjectId, std::size_t size) {
  domain_size = size;
  return AbortCode::none;
}

void TestApplication::abandon_domain(ObjectId) { ++domains_abandoned; }

// --- DeviceTest

DeviceTest::DeviceTest()
    : device({DictionaryOf<kNamed>::value, &objects.communication, rpdos, tpdos}, application) {
  device.set_node_id(kNode);
  device.power_on(now_us);
  sent();
}

void DeviceTest::pass_ms(unsigned duration_ms) {
  for (unsigned i = 0; i < duration_ms; ++i) {
    now_us += 1000;
    device.poll(now_us);
  }
}

std::vector<hal::CanFrame> DeviceTest::sent() {
  std::vector<hal::CanFrame> frames;
  hal::CanFrame frame;
  while (frames.size() < kMostFrames && device.offer(frame, now_us)) {
    device.taken(now_us);
    frames.push_back(frame);
  }
  return frames;
}

std::vector<hal::CanFrame> DeviceTest::sent(std::uint16_t id) {
  std::vector<hal::CanFrame> frames = sent();
  const auto other = [id](const hal::CanFrame& frame) { return frame.id != id; };
  frames.erase(std::remove_if(frames.begin(), frames.end(), other), frames.end());
  return frames;
}

std::vector<hal::CanFrame> DeviceTest::sent_after_ms(unsigned duration_ms) {
  std::vector<hal::CanFrame> all;
  for (unsigned i = 0; i < duration_ms; ++i) {
    pass_ms(1);
    const std::vector<hal::CanFrame> now = sent();
    all.insert(all.end(), now.begin(), now.end());
  }
  return all;
}

void DeviceTest::refuse(int times) {
  hal::CanFrame refused;
  for (int i = 0; i < times; ++i)
    static_cast<void>(device.offer(refused, now_us));
}

AbortCode DeviceTest::answer(hal::CanFrame& response) {
  const std::vector<hal::CanFrame> answers = sent(0x580 + kNode);
  EXPECT_EQ(answers.size(), 1U) << "one response to one request";
  if (answers.size() != 1) return AbortCode::general;
  response = answers[0];
  if (response.data[0] != 0x80) return AbortCode::none;
  return static_cast<AbortCode>(load_le(&response.data[4], 4));
}

AbortCode DeviceTest::write(ObjectId object, std::uint32_t value, std::size_t size) {
  const auto command = static_cast<std::uint8_t>(0x23U | ((4U - size) << 2U));
  device.receive({0x600 + kNode, 8, sdo(command, object, value)}, now_us);
  hal::CanFrame response;
  return answer(response);
}

AbortCode DeviceTest::read(ObjectId object, std::uint32_t& value) {
  device.receive({0x600 + kNode, 8, sdo(0x40, object)}, now_us);
  hal::CanFrame response;
  const AbortCode code = answer(response);
  value = static_cast<std::uint32_t>(load_le(&response.data[4], 4));
  return code;
}

std::uint32_t DeviceTest::value_of(ObjectId object) {
  std::uint32_t value = 0;
  EXPECT_EQ(read(object, value), AbortCode::none);
  return value;
}

AbortCode DeviceTest::refusal_of(ObjectId object) {
  std::uint32_t value = 0;
  return read(object, value);
}

}  // namespace volcomp::canopen::test

namespace volcomp::canopen {

template class Device<test::TestApplication>;

}  // namespace volcomp::canopen
