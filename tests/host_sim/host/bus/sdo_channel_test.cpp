// The queue of one node's transfers: an abort is its last word, and leaves before anything else.

#include <gmock/gmock.h>

#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::host {
namespace {

using canopen::SdoData;
using testing::ElementsAre;

class Channel : public ::testing::Test {
 protected:
  std::vector<SdoData> requests() {
    std::vector<SdoData> all;
    for (hal::CanFrame frame; all.size() < 200 && sdo.offer(frame); sdo.taken())
      all.push_back(frame.data);
    return all;
  }
  void answer(const SdoData& response) { sdo.receive({0x580 + 32, 8, response}, 0); }
  // A block download whose first segment has left.
  void begin_blocks() {
    sdo.write({0x2110, 1}, SdoChannel::Bytes(1000), "tables");
    sdo.poll(0);
    ASSERT_THAT(requests(), ElementsAre(SdoData{0xC6, 0x10, 0x21, 0x01, 0xE8, 0x03}));
    answer({0xA4, 0x10, 0x21, 0x01, 127});
    hal::CanFrame frame;
    ASSERT_TRUE(sdo.offer(frame));
    sdo.taken();
    ASSERT_TRUE(sdo.offer(frame)) << "and the second waits for the bus";
  }
  void read_after(const SdoData& abort) {
    sdo.read({0x1000, 0}, 4, "device type", [](const SdoChannel::Bytes&) {});
    EXPECT_THAT(requests(), ElementsAre(abort));
    sdo.poll(0);
    EXPECT_THAT(requests(), ElementsAre(SdoData{0x40, 0x00, 0x10, 0x00}));
  }

  SdoChannel sdo{32};
};

TEST_F(Channel, AbortOfABlockByTheNodeIsAnswered) {
  const SdoData no_room{0x80, 0x10, 0x21, 0x01, 0x12, 0x00, 0x07, 0x06};
  begin_blocks();
  answer(no_room);
  EXPECT_NE(sdo.failure(), "");
  EXPECT_FALSE(sdo.idle()) << "the abort has not left";
  sdo.clear();
  read_after(no_room);
}

TEST_F(Channel, TransferThatIsForgottenIsAborted) {
  begin_blocks();
  sdo.clear();
  read_after({0x80, 0x10, 0x21, 0x01, 0x00, 0x00, 0x00, 0x08});
}

TEST_F(Channel, WithoutATransferThereIsNothingToAbort) {
  sdo.clear();
  EXPECT_TRUE(sdo.idle());
  EXPECT_TRUE(requests().empty());
}

}  // namespace
}  // namespace volcomp::host
