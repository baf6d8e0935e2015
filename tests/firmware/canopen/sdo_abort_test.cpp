// Every reason for which the server ends a transfer by itself, provoked once.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class SdoServerAborts : public ::testing::Test {
 protected:
  void SetUp() override { objects.add(kObject, 20, pattern(20)); }

  // The abort frame of the object under test; the code in its hand-written byte order.
  static SdoData aborted(std::uint8_t b0, std::uint8_t b1, std::uint8_t b2, std::uint8_t b3) {
    return {0x80, 0x10, 0x21, 0x01, b0, b1, b2, b3};
  }
  // Sends all but the last request, whatever the answers, and returns the answer to the last.
  std::vector<SdoData> last_answer(const std::vector<SdoData>& requests) {
    std::vector<SdoData> answers = ask(server, kClientAbort);
    for (const SdoData& request : requests)
      answers = ask(server, request);
    EXPECT_FALSE(objects.open()) << "the download must be abandoned";
    EXPECT_TRUE(objects.guards_intact());
    return answers;
  }

  // Ends what the case before has left behind.
  static constexpr SdoData kClientAbort{0x80, 0x10, 0x21, 0x01, 0, 0, 0, 0x08};

  FakeObjects objects;
  SdoServer server{objects};
  const SdoData download{0x21, 0x10, 0x21, 0x01, 20};
  const SdoData upload{0x40, 0x10, 0x21, 0x01};
  const SdoData block_download{0xC6, 0x10, 0x21, 0x01, 9};
  const SdoData block_upload{0xA4, 0x10, 0x21, 0x01, 127};
};

TEST_F(SdoServerAborts, ToggleBitOfADownload) {
  EXPECT_THAT(last_answer({download, {0x10}}), ElementsAre(aborted(0, 0, 3, 5)));
  EXPECT_THAT(last_answer({download, {0x00}, {0x00}}), ElementsAre(aborted(0, 0, 3, 5)));
  EXPECT_EQ(objects.abandoned(), 2);
}

TEST_F(SdoServerAborts, ToggleBitOfAnUpload) {
  EXPECT_THAT(last_answer({upload, {0x70}}), ElementsAre(aborted(0, 0, 3, 5)));
}

TEST_F(SdoServerAborts, Timeout) {
  for (const SdoData& start : {download, upload, block_download, block_upload}) {
    ask(server, start, 0);
    server.poll(999'999);
    for (const SdoData& response : responses(server))
      EXPECT_NE(response[0], 0x80);
    server.poll(1'000'000);
    EXPECT_THAT(responses(server), ElementsAre(aborted(0, 0, 4, 5)));
    server.poll(1'999'999);
    server.poll(5'000'000);
    EXPECT_THAT(responses(server), IsEmpty()) << "once is enough";
  }
  EXPECT_EQ(objects.abandoned(), 2);
}

TEST_F(SdoServerAborts, TimeoutAsSet) {
  server.set_timeout_us(50'000);
  ask(server, upload, 1'000);
  ask(server, {0x60}, 50'000);
  server.poll(99'999);
  EXPECT_THAT(responses(server), IsEmpty()) << "every request starts the time again";
  server.poll(100'000);
  EXPECT_THAT(responses(server), ElementsAre(aborted(0, 0, 4, 5)));
}

TEST_F(SdoServerAborts, CommandsThatBelongToNoTransfer) {
  const SdoData without_object{0x80, 0, 0, 0, 0x01, 0x00, 0x04, 0x05};
  for (const std::uint8_t command :
       Bytes{0x00, 0x10, 0x60, 0x70, 0xA1, 0xA2, 0xA3, 0xC1, 0x81, 0xE0})
    EXPECT_THAT(last_answer({{command}}), ElementsAre(without_object)) << +command;
}

TEST_F(SdoServerAborts, CommandsThatBelongToAnotherTransfer) {
  EXPECT_THAT(last_answer({download, {0x60}}), ElementsAre(aborted(1, 0, 4, 5)));
  EXPECT_THAT(last_answer({upload, {0x00}}), ElementsAre(aborted(1, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_upload, {0xA2, 1, 127}}), ElementsAre(aborted(1, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_upload, {0xA3}, {0xA1}}), ElementsAre(aborted(1, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_download, {0x82}, {0x81}, {0x82}}),
              ElementsAre(aborted(1, 0, 4, 5)));
}

TEST_F(SdoServerAborts, BlockSize) {
  EXPECT_THAT(last_answer({{0xA4, 0x10, 0x21, 0x01, 0}}), ElementsAre(aborted(2, 0, 4, 5)));
  EXPECT_THAT(last_answer({{0xA4, 0x10, 0x21, 0x01, 128}}), ElementsAre(aborted(2, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_upload, {0xA3}, {0xA2, 1, 0}}), ElementsAre(aborted(2, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_upload, {0xA3}, {0xA2, 1, 128}}),
              ElementsAre(aborted(2, 0, 4, 5)));
}

TEST_F(SdoServerAborts, SequenceNumber) {
  EXPECT_THAT(last_answer({block_download, {0x00}}), ElementsAre(aborted(3, 0, 4, 5)));
  EXPECT_THAT(last_answer({block_upload, {0xA3}, {0xA2, 4, 127}}), ElementsAre(aborted(3, 0, 4, 5)))
      << "20 bytes are three segments; a fourth cannot be confirmed";
}

TEST_F(SdoServerAborts, Checksum) {
  EXPECT_THAT(last_answer({block_download, {0x01}, {0x82}, {0xD5, 0xFF, 0xFF}}),
              ElementsAre(aborted(4, 0, 4, 5)));
  EXPECT_EQ(objects.abandoned(), 1);
  EXPECT_EQ(objects.finished(), 0);
}

TEST_F(SdoServerAborts, MoreThanAnnounced) {
  EXPECT_THAT(last_answer({{0x21, 0x10, 0x21, 0x01, 8}, {0x00}, {0x1B}}),
              ElementsAre(aborted(0x12, 0, 7, 6)));
  EXPECT_THAT(last_answer({block_download, {0x01}, {0x02}}), ElementsAre(aborted(0x12, 0, 7, 6)));
  EXPECT_THAT(last_answer({block_download, {0x01}, {0x82}, {0xD1}}),
              ElementsAre(aborted(0x12, 0, 7, 6)));
}

TEST_F(SdoServerAborts, MoreThanTheObjectHolds) {
  EXPECT_THAT(last_answer({{0x21, 0x10, 0x21, 0x01, 21}}), ElementsAre(aborted(0x12, 0, 7, 6)));
  EXPECT_THAT(last_answer({{0x20, 0x10, 0x21, 0x01}, {0x00}, {0x10}, {0x00}}),
              ElementsAre(aborted(0x12, 0, 7, 6)));
  EXPECT_THAT(last_answer({{0xC4, 0x10, 0x21, 0x01}, {0x01}, {0x02}, {0x03}}),
              ElementsAre(aborted(0x12, 0, 7, 6)));
  objects.add(kObject, 2);
  EXPECT_THAT(last_answer({{0x23, 0x10, 0x21, 0x01, 1, 2, 3, 4}}),
              ElementsAre(aborted(0x12, 0, 7, 6)));
}

TEST_F(SdoServerAborts, LessThanAnnounced) {
  EXPECT_THAT(last_answer({{0x21, 0x10, 0x21, 0x01, 8}, {0x01}}),
              ElementsAre(aborted(0x13, 0, 7, 6)));
  EXPECT_THAT(last_answer({block_download, {0x81}, {0xC1}}), ElementsAre(aborted(0x13, 0, 7, 6)));
  EXPECT_EQ(objects.finished(), 0);
}

TEST_F(SdoServerAborts, ReasonsOfTheObject) {
  EXPECT_THAT(ask(server, {0x40, 0x77, 0x66, 0x55}),
              ElementsAre(SdoData{0x80, 0x77, 0x66, 0x55, 0x00, 0x00, 0x02, 0x06}));
  objects.at(kObject).on_upload = AbortCode::write_only;
  EXPECT_THAT(last_answer({upload}), ElementsAre(aborted(1, 0, 1, 6)));
  EXPECT_THAT(last_answer({block_upload}), ElementsAre(aborted(1, 0, 1, 6)));
  objects.at(kObject).on_finish = AbortCode::wrong_length;
  EXPECT_THAT(last_answer({{0x2F, 0x10, 0x21, 0x01, 1}}), ElementsAre(aborted(0x10, 0, 7, 6)));
  EXPECT_EQ(objects.abandoned(), 0) << "a finished download is not abandoned";
  objects.at(kObject).on_download = AbortCode::read_only;
  EXPECT_THAT(last_answer({download}), ElementsAre(aborted(2, 0, 1, 6)));
  EXPECT_THAT(last_answer({block_download}), ElementsAre(aborted(2, 0, 1, 6)));
  EXPECT_EQ(objects.abandoned(), 0) << "a refused download never began";
}

}  // namespace
}  // namespace volcomp::canopen::test
