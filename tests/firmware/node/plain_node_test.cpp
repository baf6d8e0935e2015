// A node built with VOLCOMP_NODE_PROBING=OFF: nothing of the probe is in its dictionary, and what
// remains is as in every node.

#include <array>

#include <gtest/gtest.h>

#include "firmware/node/node.hpp"

namespace volcomp::node {
namespace {

static_assert(!kProbes && !kWatchesStrokes && !kOrientsTool && kFollowsTemperature);

bool of_probe(std::uint16_t index) {
  const bool latched = index == 0x2015 || (index >= 0x2017 && index <= 0x2019);
  return latched || (index >= 0x2300 && index < 0x2500);
}

class PlainNode : public ::testing::Test {
 protected:
  PlainNode() { node_.power_on(0); }

  [[nodiscard]] const canopen::ObjectDictionary& objects() const {
    return node_.device().objects();
  }
  [[nodiscard]] canopen::AbortCode look_up(std::uint16_t index) const {
    return objects().find({index, 1}).why;
  }

  Node node_{32, nullptr};
};

TEST_F(PlainNode, HasNoObjectOfTheProbe) {
  for (const canopen::Entry& row : objects().rows())
    EXPECT_FALSE(of_probe(row.index)) << std::hex << row.index;
  constexpr std::array<std::uint16_t, 8> kOfProbe{0x2015, 0x2017, 0x2018, 0x2019,
                                                  0x2300, 0x2313, 0x2401, 0x2410};
  for (const std::uint16_t index : kOfProbe)
    EXPECT_EQ(look_up(index), canopen::AbortCode::no_object) << std::hex << index;
}

TEST_F(PlainNode, HasEveryOtherObject) {
  constexpr std::array<std::uint16_t, 8> kOfEveryNode{0x2011, 0x2013, 0x2016, 0x201B,
                                                      0x2020, 0x2112, 0x2600, 0x2700};
  for (const std::uint16_t index : kOfEveryNode)
    EXPECT_EQ(look_up(index), canopen::AbortCode::none) << std::hex << index;
}

// RPDO and TPDO keep their numbers; those of latches are off, those of points are not there.
TEST_F(PlainNode, MapsNothingOfTheProbe) {
  NodeObjects o = default_objects();
  for (std::size_t a = 0; a < kNodeAxes; ++a)
    o.drive[a] = static_cast<std::uint8_t>(a + 1);
  for (const Way way : {Way::offset, Way::forwarded_target}) {
    o.way.fill(static_cast<std::uint8_t>(way));
    for (std::size_t i = 0; i < kReceivePdos; ++i) {
      const canopen::PdoParameters p = default_receive_pdo(i, o);
      canopen::Pdo pdo;
      EXPECT_EQ(pdo.configure(p, canopen::PdoKind::receive, objects()), canopen::AbortCode::none)
          << i;
      const bool off = i >= kFirstLatchPdo && i <= kProcessStatePdo;
      const bool unwanted = i >= kFirstHeldPdo && i < kFirstLatchPdo && way != Way::offset;
      EXPECT_EQ(pdo.valid(), !off && !unwanted) << i;
      for (std::size_t k = 0; k < p.count; ++k)
        EXPECT_FALSE(of_probe(canopen::object_of(p.mapping[k]).index)) << i;
    }
  }
  EXPECT_EQ(kTransmitPdos, kStatusPdo + 1);
  for (std::size_t i = 0; i < kTransmitPdos; ++i) {
    canopen::Pdo pdo;
    EXPECT_EQ(pdo.configure(default_transmit_pdo(i, o, 32), canopen::PdoKind::transmit, objects()),
              canopen::AbortCode::none)
        << i;
  }
}

// TPDO1 of a drive still has eight bytes: position, status, and the word of its probe.
TEST_F(PlainNode, HearsTheDriveAsEveryNodeDoes) {
  NodeObjects o = default_objects();
  o.drive[0] = 1;
  canopen::Pdo pdo;
  ASSERT_EQ(pdo.configure(default_receive_pdo(kNodeAxes, o), canopen::PdoKind::receive, objects()),
            canopen::AbortCode::none);
  EXPECT_EQ(pdo.parameters().count, 3);
  EXPECT_EQ(pdo.parameters().mapping[2], 0x00060010U);
}

}  // namespace
}  // namespace volcomp::node
