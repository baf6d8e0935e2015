// DeviceBase::heard(): a filter in front of the port with these identifiers changes nothing.

#include <algorithm>
#include <cstring>
#include <deque>
#include <random>

#include <gtest/gtest.h>

#include "firmware/node/node.hpp"

namespace volcomp::node {
namespace {

bool hears(const Node& node, std::uint16_t id) {
  canopen::DeviceBase::HeardIds ids{};
  const std::size_t count = node.device().heard(ids);
  return std::find(ids.begin(), ids.begin() + count, id) != ids.begin() + count;
}

class Twins {
 public:
  Twins() {
    all.power_on(0);
    filtered.power_on(0);
  }

  // To both, to the second only what it hears; then a millisecond passes.
  void give(const hal::CanFrame& frame) {
    all.device().receive(frame, now_us);
    if (hears(filtered, frame.id)) filtered.device().receive(frame, now_us);
    now_us += 1000;
    const auto one = said(all);
    const auto other = said(filtered);
    ASSERT_EQ(one.size(), other.size()) << "after " << std::hex << frame.id;
    for (std::size_t i = 0; i < one.size(); ++i)
      ASSERT_EQ(one[i], other[i]) << "after " << std::hex << frame.id;
  }
  // Every value of the dictionary; between them the structure has bytes that nobody sets.
  [[nodiscard]] bool alike() const {
    const canopen::ObjectDictionary& objects = all.device().objects();
    for (const canopen::Entry& row : objects.rows()) {
      const bool text = row.type() == canopen::DataType::visible_string;
      const std::size_t size = text ? std::size_t{row.extra} : row.size();
      for (unsigned sub = row.first_sub; sub <= row.last_sub; ++sub) {
        const canopen::ObjectId object{row.index, static_cast<std::uint8_t>(sub)};
        const std::uint8_t* const one = objects.find(object).value;
        const std::uint8_t* const other = filtered.device().objects().find(object).value;
        if (one != nullptr && std::memcmp(one, other, size) != 0) return false;
      }
    }
    return true;
  }

  Node all{32, nullptr};
  Node filtered{32, nullptr};
  std::uint64_t now_us = 0;

 private:
  [[nodiscard]] std::deque<hal::CanFrame> said(Node& node) const {
    std::deque<hal::CanFrame> frames;
    hal::CanFrame frame;
    node.device().poll(now_us);
    while (node.device().offer(frame, now_us)) {
      node.device().taken(now_us);
      frames.push_back(frame);
    }
    return frames;
  }
};

// Any frames, among them NMT commands and SDO requests that change PDOs, SYNC and watched nodes:
// what is heard follows.
TEST(HeardIds, NoOtherFrameDoesAnything) {
  Twins twins;
  std::mt19937 random(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  const auto any = [&random](unsigned below) { return static_cast<unsigned>(random() % below); };
  const std::array<std::array<std::uint8_t, 4>, 8> writes{{{0x23, 0x05, 0x10, 0},
                                                           {0x23, 0x16, 0x10, 1},
                                                           {0x23, 0x16, 0x10, 2},
                                                           {0x23, 0x00, 0x14, 1},
                                                           {0x23, 0x03, 0x14, 1},
                                                           {0x23, 0x0A, 0x14, 1},
                                                           {0x2B, 0x17, 0x10, 0},
                                                           {0x40, 0x18, 0x10, 1}}};
  constexpr int kFrames = 30'000;
  for (int i = 0; i < kFrames && !testing::Test::HasFatalFailure(); ++i) {
    hal::CanFrame frame;
    for (std::uint8_t& byte : frame.data)
      byte = static_cast<std::uint8_t>(any(256));
    frame.size = static_cast<std::uint8_t>(any(9));
    frame.id = static_cast<std::uint16_t>(any(0x800));
    const unsigned kind = any(10);
    if (kind == 0) {
      frame = {0x000, 2, {static_cast<std::uint8_t>(any(2) == 0 ? 1 : 128), 32}};
    } else if (kind < 4) {
      frame.id = 0x620;
      frame.size = 8;
      std::copy_n(writes.at(any(writes.size())).begin(), 4, frame.data.begin());
      frame.data[5] = static_cast<std::uint8_t>(any(8));
      frame.data[6] = static_cast<std::uint8_t>(any(6));
      frame.data[7] = any(2) == 0 ? std::uint8_t{0} : std::uint8_t{0x80};
    }
    twins.give(frame);
  }
  EXPECT_TRUE(twins.alike());
}

void write(Node& node, canopen::ObjectId object, std::uint32_t value) {
  std::array<std::uint8_t, 4> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  ASSERT_EQ(node.device().write(object, bytes), canopen::AbortCode::none);
}

TEST(HeardIds, FollowTheConfiguration) {
  Node node(32, nullptr);
  node.power_on(0);
  const auto hears_all = [&node](std::initializer_list<unsigned> ids) {
    return std::all_of(ids.begin(), ids.end(), [&node](unsigned id) {
      return hears(node, static_cast<std::uint16_t>(id));
    });
  };
  EXPECT_TRUE(hears_all({0x000, 0x080, 0x100, 0x620}));
  for (const unsigned id : {0x123U, 0x182U, 0x621U, 0x5A0U, 0x703U})
    EXPECT_FALSE(hears_all({id})) << std::hex << id;
  write(node, {0x1016, 1}, 3U << 16U | 100U);
  write(node, {0x1400, 1}, 0x182);
  write(node, {0x1005, 0}, 0x090);
  EXPECT_TRUE(hears_all({0x703, 0x182, 0x090}));
  EXPECT_FALSE(hears_all({0x080}));
}

}  // namespace
}  // namespace volcomp::node
