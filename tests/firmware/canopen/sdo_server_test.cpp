// Expedited and segmented transfers, byte by byte as in CiA 301, sections 7.2.4.3.3 to 7.2.4.3.7.

#include "tests/firmware/canopen/sdo_support.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr ObjectId kServed{0x2110, 0x03};

class SdoServerFrames : public ::testing::Test {
 protected:
  FakeObjects objects;
  SdoServer server{objects};
};

TEST_F(SdoServerFrames, ExpeditedUploadOfOneToFourBytes) {
  FakeObjects::Object& object = objects.add(kServed, 4);
  const SdoData request{0x40, 0x10, 0x21, 0x03};
  object.value = {0x11};
  EXPECT_THAT(ask(server, request), ElementsAre(SdoData{0x4F, 0x10, 0x21, 0x03, 0x11}));
  object.value = {0x11, 0x22};
  EXPECT_THAT(ask(server, request), ElementsAre(SdoData{0x4B, 0x10, 0x21, 0x03, 0x11, 0x22}));
  object.value = {0x11, 0x22, 0x33};
  EXPECT_THAT(ask(server, request), ElementsAre(SdoData{0x47, 0x10, 0x21, 0x03, 0x11, 0x22, 0x33}));
  object.value = {0x11, 0x22, 0x33, 0x44};
  EXPECT_THAT(ask(server, request),
              ElementsAre(SdoData{0x43, 0x10, 0x21, 0x03, 0x11, 0x22, 0x33, 0x44}));
}

TEST_F(SdoServerFrames, ExpeditedDownloadOfOneToFourBytes) {
  const FakeObjects::Object& object = objects.add(kServed, 4);
  const SdoData confirmation{0x60, 0x10, 0x21, 0x03};
  EXPECT_THAT(ask(server, {0x2F, 0x10, 0x21, 0x03, 0x11}), ElementsAre(confirmation));
  EXPECT_EQ(object.value, Bytes({0x11}));
  EXPECT_THAT(ask(server, {0x2B, 0x10, 0x21, 0x03, 0x11, 0x22}), ElementsAre(confirmation));
  EXPECT_EQ(object.value, Bytes({0x11, 0x22}));
  EXPECT_THAT(ask(server, {0x27, 0x10, 0x21, 0x03, 0x11, 0x22, 0x33}), ElementsAre(confirmation));
  EXPECT_EQ(object.value, Bytes({0x11, 0x22, 0x33}));
  EXPECT_THAT(ask(server, {0x23, 0x10, 0x21, 0x03, 0x11, 0x22, 0x33, 0x44}),
              ElementsAre(confirmation));
  EXPECT_EQ(object.value, Bytes({0x11, 0x22, 0x33, 0x44}));
}

TEST_F(SdoServerFrames, ExpeditedDownloadWithoutSizeFillsTheObject) {
  const FakeObjects::Object& object = objects.add(kServed, 2);
  EXPECT_THAT(ask(server, {0x22, 0x10, 0x21, 0x03, 0x11, 0x22, 0x33, 0x44}),
              ElementsAre(SdoData{0x60, 0x10, 0x21, 0x03}));
  EXPECT_EQ(object.value, Bytes({0x11, 0x22}));
  EXPECT_EQ(objects.announced(), 0U);
}

TEST_F(SdoServerFrames, SegmentedUploadTogglesAndEndsWithTheLastBit) {
  objects.add(kServed, 16, bytes_of("compensation 123"));
  EXPECT_THAT(ask(server, {0x40, 0x10, 0x21, 0x03}),
              ElementsAre(SdoData{0x41, 0x10, 0x21, 0x03, 16, 0, 0, 0}));
  EXPECT_THAT(ask(server, {0x60}), ElementsAre(SdoData{0x00, 'c', 'o', 'm', 'p', 'e', 'n', 's'}));
  EXPECT_THAT(ask(server, {0x70}), ElementsAre(SdoData{0x10, 'a', 't', 'i', 'o', 'n', ' ', '1'}));
  EXPECT_THAT(ask(server, {0x60}), ElementsAre(SdoData{0x0B, '2', '3'}));
}

TEST_F(SdoServerFrames, SegmentedUploadOfFullSegments) {
  objects.add(kServed, 7, bytes_of("1234567"));
  EXPECT_THAT(ask(server, {0x40, 0x10, 0x21, 0x03}),
              ElementsAre(SdoData{0x41, 0x10, 0x21, 0x03, 7}));
  EXPECT_THAT(ask(server, {0x60}), ElementsAre(SdoData{0x01, '1', '2', '3', '4', '5', '6', '7'}));
}

TEST_F(SdoServerFrames, EmptyObjectIsOneEmptySegment) {
  objects.add(kServed, 7);
  EXPECT_THAT(ask(server, {0x40, 0x10, 0x21, 0x03}), ElementsAre(SdoData{0x41, 0x10, 0x21, 0x03}));
  EXPECT_THAT(ask(server, {0x60}), ElementsAre(SdoData{0x0F}));
}

TEST_F(SdoServerFrames, SegmentedDownloadTogglesAndEndsWithTheLastBit) {
  const FakeObjects::Object& object = objects.add(kServed, 16);
  EXPECT_THAT(ask(server, {0x21, 0x10, 0x21, 0x03, 16}),
              ElementsAre(SdoData{0x60, 0x10, 0x21, 0x03}));
  EXPECT_EQ(objects.announced(), 16U);
  EXPECT_THAT(ask(server, {0x00, 'c', 'o', 'm', 'p', 'e', 'n', 's'}), ElementsAre(SdoData{0x20}));
  EXPECT_THAT(ask(server, {0x10, 'a', 't', 'i', 'o', 'n', ' ', '1'}), ElementsAre(SdoData{0x30}));
  EXPECT_TRUE(object.value.empty()) << "the value must not change before the last segment";
  EXPECT_THAT(ask(server, {0x0B, '2', '3', 0xEE, 0xEE, 0xEE, 0xEE, 0xEE}),
              ElementsAre(SdoData{0x20}));
  EXPECT_EQ(object.value, bytes_of("compensation 123"));
}

TEST_F(SdoServerFrames, SegmentedDownloadWithoutSize) {
  const FakeObjects::Object& object = objects.add(kServed, 16);
  EXPECT_THAT(ask(server, {0x20, 0x10, 0x21, 0x03}), ElementsAre(SdoData{0x60, 0x10, 0x21, 0x03}));
  EXPECT_EQ(objects.announced(), 0U);
  EXPECT_THAT(ask(server, {0x05, 'v', 'o', 'l', 'c', 'p'}), ElementsAre(SdoData{0x20}));
  EXPECT_EQ(object.value, bytes_of("volcp"));
}

TEST_F(SdoServerFrames, DownloadOfNothing) {
  const FakeObjects::Object& object = objects.add(kServed, 16, bytes_of("old"));
  EXPECT_THAT(ask(server, {0x21, 0x10, 0x21, 0x03}), ElementsAre(SdoData{0x60, 0x10, 0x21, 0x03}));
  EXPECT_THAT(ask(server, {0x0F}), ElementsAre(SdoData{0x20}));
  EXPECT_TRUE(object.value.empty());
  EXPECT_EQ(objects.finished(), 1);
}

TEST_F(SdoServerFrames, ClientAbortEndsTheTransferSilently) {
  objects.add(kServed, 16);
  ask(server, {0x21, 0x10, 0x21, 0x03, 16});
  EXPECT_THAT(ask(server, {0x80, 0x10, 0x21, 0x03, 0, 0, 0, 0x08}), IsEmpty());
  EXPECT_EQ(objects.abandoned(), 1);
  EXPECT_THAT(ask(server, {0x00}), ElementsAre(SdoData{0x80, 0, 0, 0, 0x01, 0, 0x04, 0x05}));
}

TEST_F(SdoServerFrames, ResetDropsTransferAndResponseSilently) {
  objects.add(kServed, 16);
  server.request({0x21, 0x10, 0x21, 0x03, 16}, 0);
  server.reset();
  EXPECT_EQ(objects.abandoned(), 1);
  EXPECT_THAT(responses(server), IsEmpty());
  server.poll(10'000'000);
  EXPECT_THAT(responses(server), IsEmpty());
  server.reset();
  EXPECT_EQ(objects.abandoned(), 1) << "only an open download can be abandoned";
}

}  // namespace
}  // namespace volcomp::canopen::test
