#pragma once
// A device with a small application area, an application that records its calls, and a bus end that
// hands over byte strings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "firmware/canopen/device.hpp"

namespace volcomp::canopen::test {

// A frame written out byte by byte.
hal::CanFrame frame(std::uint16_t id, const std::vector<unsigned>& bytes);

struct TestObjects {
  CommunicationObjects communication;
  std::uint16_t control = 0;                    // 6040h, RPDO
  std::uint16_t status = 0;                     // 6041h, TPDO
  std::int32_t actual = 0;                      // 6064h, TPDO
  std::int32_t target = 0;                      // 607Ah, RPDO
  std::uint16_t word = 0;                       // 2000h: 10…1000
  std::int8_t small = 0;                        // 2001h: −5…5
  std::array<std::uint32_t, 4> list{};          // 2002h:01…04
  std::array<char, 8> text{};                   // 2003h
  std::uint8_t secret = 0;                      // 2004h, write only
  std::uint64_t wide = 0x1122'3344'5566'7788U;  // 2005h, TPDO
  std::int16_t fixed = -2;                      // 2006h, constant
};

class TestApplication;
using TestDevice = Device<TestApplication>;

class TestApplication final {
 public:
  struct HeartbeatNews {
    std::uint8_t node;
    HeartbeatEvent event;
  };

  TestObjects& objects;
  std::vector<std::string> resets;  // "application", "communication"
  std::vector<NmtState> states;
  std::vector<std::uint8_t> sync_counters;
  std::vector<std::int32_t> target_at_sync;
  std::vector<HeartbeatNews> heartbeats;
  std::vector<SyncVerdict> bad_syncs;
  std::vector<std::uint16_t> received_ids;
  bool loss_is_error = true;
  std::array<std::uint8_t, 1500> domain{};  // 2010h
  std::size_t domain_size = 0;
  int domains_abandoned = 0;

  explicit TestApplication(TestObjects& values) : objects(values) {}

 private:
  friend TestDevice;
  void reset_application() { resets.emplace_back("application"); }
  void reset_communication();
  void state_changed(NmtState state, std::uint64_t now_us);
  void sync(std::uint8_t counter, std::uint64_t now_us);
  void received(const Pdo& pdo, std::uint64_t now_us);
  void sent(std::size_t /*transmit_pdo*/) {}
  void due(std::uint64_t /*now_us*/) {}
  void background(std::uint64_t /*now_us*/) {}
  void time_of_day(std::uint32_t /*midnight_ms*/, std::uint16_t /*days*/) {}
  bool heartbeat(std::uint8_t node, HeartbeatEvent event, std::uint64_t now_us);
  void bad_sync(SyncVerdict verdict, std::uint64_t now_us);
  AbortCode before_write(ObjectId /*object*/, Span<const std::uint8_t> /*bytes*/) {
    return AbortCode::none;
  }
  void written(ObjectId /*object*/, std::uint64_t /*now_us*/) {}
  void before_read(ObjectId /*object*/) {}
  AbortCode read_domain(ObjectId object, Span<const std::uint8_t>& source);
  AbortCode begin_domain(ObjectId object, std::size_t announced, Span<std::uint8_t>& sink);
  AbortCode finish_domain(ObjectId object, std::size_t size);
  void abandon_domain(ObjectId object);
};

// Node 5, powered on, its boot-up message taken. Time stands still unless a test moves it.
class DeviceTest : public ::testing::Test {
 protected:
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::uint8_t kNobody = 255;
  static constexpr std::size_t kMostFrames = 1000;

  DeviceTest();

  void receive(std::uint16_t id, const std::vector<unsigned>& bytes) {
    device.receive(frame(id, bytes), now_us);
  }
  // NMT commands as they go over the bus.
  void start() { receive(0x000, {0x01, kNode}); }
  void stop() { receive(0x000, {0x02, kNode}); }

  // Polls at every millisecond on the way.
  void pass_ms(unsigned duration_ms);
  // Everything the device has to send now, at most kMostFrames.
  std::vector<hal::CanFrame> sent();
  std::vector<hal::CanFrame> sent(std::uint16_t id);
  std::vector<hal::CanFrame> sent_after_ms(unsigned duration_ms);
  // The port is full: what is offered is not taken, so many times.
  void refuse(int times);

  // An expedited SDO transfer with its frames; the abort code, or none. Other frames are dropped.
  AbortCode write(ObjectId object, std::uint32_t value, std::size_t size);
  AbortCode read(ObjectId object, std::uint32_t& value);
  std::uint32_t value_of(ObjectId object);
  AbortCode refusal_of(ObjectId object);

  TestObjects objects;
  TestApplication application{objects};
  std::array<Pdo, 3> rpdos{};
  std::array<Pdo, 3> tpdos{};
  std::uint64_t now_us = 1'000'000;
  TestDevice device;

 private:
  AbortCode answer(hal::CanFrame& response);
};

}  // namespace volcomp::canopen::test
