// Segments that are lost inside a block are sent again; the value arrives whole.

#include <random>

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

// Loses block segments and nothing else. Which frames are segments follows from the conversation:
// all between the confirmation that opens a block and the one that closes it. A block that follows
// one whose end was lost, or of which nothing was taken, arrives undisturbed: two silences running
// are a dead line, and the same end twice in a row is one frame doubled.
class SegmentLoss {
 public:
  SegmentLoss(unsigned seed, double probability, std::size_t size)
      : random_(seed), lost_(probability), left_((size + 6) / 7) {}

  // A segment that does not end its block.
  static bool inside(const SdoData& frame) { return frame[0] < kMostBlockSegments; }
  // A frame of the side that sends the data.
  bool data_side(const SdoData&) {
    end_lost_ = in_block_ && !spared_ && left_ != 0 && lost_(random_);
    return end_lost_;
  }
  // A frame of the side that receives it; `opening` is the first byte of the one before all blocks.
  bool receiving_side(const SdoData& frame, std::uint8_t opening) {
    if (frame[0] == opening) in_block_ = true;
    if (frame[0] != 0xA2) return false;
    left_ -= frame[1];
    spared_ = end_lost_ || frame[1] == 0;
    return false;
  }

 private:
  std::mt19937 random_;
  std::bernoulli_distribution lost_;
  std::size_t left_;  // segments not confirmed yet
  bool in_block_ = false;
  bool spared_ = false;
  bool end_lost_ = false;
};

class SdoLoss : public ::testing::TestWithParam<double> {
 protected:
  void SetUp() override { client.set_block_threshold(5); }

  FakeObjects objects;
  SdoServer server{objects};
  SdoClient client;
};

std::size_t random_size(unsigned seed) { return 5 + (seed * 2654435761U >> 7U) % 3000; }

TEST_P(SdoLoss, DownloadArrivesWhole) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Bytes value = pattern(random_size(seed), seed);
    objects.add(kObject, value.size());
    SegmentLoss loss(seed, GetParam(), value.size());
    Line line{client, server};
    // The end of a block that is lost ends the transfer.
    line.lose_request = [&](const SdoData& frame) {
      return SegmentLoss::inside(frame) && loss.data_side(frame);
    };
    line.lose_response = [&](const SdoData& frame) { return loss.receiving_side(frame, 0xA4); };
    client.download(kObject, {value.data(), value.size()}, 0);
    line.run();
    ASSERT_EQ(client.state(), SdoClient::State::done) << sentence(client.abort_code());
    ASSERT_EQ(objects.at(kObject).value, value);
    ASSERT_TRUE(objects.guards_intact());
  }
}

TEST_P(SdoLoss, UploadArrivesWhole) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Bytes value = pattern(random_size(seed), seed);
    objects.add(kObject, value.size(), value);
    SegmentLoss loss(seed, GetParam(), value.size());
    Line line{client, server};
    line.lose_request = [&](const SdoData& frame) { return loss.receiving_side(frame, 0xA3); };
    line.lose_response = [&](const SdoData& frame) { return loss.data_side(frame); };
    Bytes memory(value.size());
    client.upload(kObject, {memory.data(), memory.size()}, 0);
    line.run();
    ASSERT_EQ(client.state(), SdoClient::State::done) << sentence(client.abort_code());
    ASSERT_EQ(memory, value);
  }
}

INSTANTIATE_TEST_SUITE_P(Probability, SdoLoss, ::testing::Values(0.01, 0.1, 0.4));

}  // namespace
}  // namespace volcomp::canopen::test
