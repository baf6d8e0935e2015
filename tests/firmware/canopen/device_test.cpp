// The device as a whole: a bus that is always full loses nothing but stale process data, and no
// frames whatsoever make it fall silent or babble.

#include <algorithm>
#include <random>

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<unsigned> kReadDeviceType{0x40, 0x00, 0x10, 0, 0, 0, 0, 0};
const std::vector<unsigned> kDeviceType{0x43, 0x00, 0x10, 0, 0x92, 0x01, 0x02, 0x00};

// --- a port that is full

class FullPort : public DeviceTest {
 protected:
  void SetUp() override {
    PdoParameters p;
    p.cob_id = 0x185;
    p.type = 255;
    p.count = 1;
    p.mapping = {mapped(0x6041, 0, 16)};
    ASSERT_EQ(tpdos[0].configure(p, PdoKind::transmit, device.objects()), AbortCode::none);
    objects.communication.producer_heartbeat_ms = 10;
    start();
  }
};

TEST_F(FullPort, LosesNothingButStaleProcessData) {
  receive(0x605, kReadDeviceType);
  device.emergency().raise(ErrorCode::rpdo_timeout, 1);
  device.emergency().raise(ErrorCode::rpdo_timeout, 2);
  for (std::uint16_t i = 1; i <= 100; ++i) {
    objects.status = i;
    device.trigger(0);
    pass_ms(1);
    refuse(3);
  }
  EXPECT_THAT(sent(),
              ElementsAre(frame(0x085, {0x50, 0x82, 0x11, 1, 0, 0, 0, 0}),
                          frame(0x085, {0x50, 0x82, 0x11, 2, 0, 0, 0, 0}), frame(0x185, {100, 0}),
                          frame(0x585, kDeviceType), frame(0x705, {0x05})));
}

TEST_F(FullPort, BootUpIsNotLost) {
  receive(0x000, {0x81, kNode});
  pass_ms(100);
  refuse(3);
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
}

TEST_F(FullPort, MoreUrgentFramesOvertake) {
  receive(0x605, kReadDeviceType);
  hal::CanFrame refused;
  ASSERT_TRUE(device.offer(refused, now_us));
  ASSERT_EQ(refused.id, 0x585);
  device.trigger(0);
  EXPECT_THAT(sent(), ElementsAre(frame(0x185, {0, 0}), frame(0x585, kDeviceType)));
}

TEST_F(FullPort, BlockUploadArrivesCompleteAndInOrder) {
  for (std::size_t i = 0; i < 700; ++i)
    application.domain[i] = static_cast<std::uint8_t>(i * 7);
  application.domain_size = 700;
  receive(0x605, {0xA0, 0x10, 0x20, 0, 127, 0, 0, 0});
  sent();
  receive(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});
  std::vector<std::uint8_t> bytes;
  hal::CanFrame segment;
  for (refuse(2); device.offer(segment, now_us); refuse(2)) {
    device.taken(now_us);
    EXPECT_EQ(segment.data[0] & 0x7FU, bytes.size() / 7 + 1);
    bytes.insert(bytes.end(), segment.data.begin() + 1, segment.data.end());
  }
  ASSERT_EQ(bytes.size(), 700U);
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), application.domain.begin()));
}

TEST_F(DeviceTest, ResetBetweenOfferAndTakenIsHarmless) {
  device.emergency().raise(ErrorCode::rpdo_timeout, 1);
  hal::CanFrame offered;
  ASSERT_TRUE(device.offer(offered, now_us));
  receive(0x000, {0x81, kNode});
  device.taken(now_us);
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
}

TEST_F(DeviceTest, FramesOfOthersAreNotAnswered) {
  start();
  for (std::uint16_t id = 0x081; id <= hal::kMaxCanId; ++id) {
    if (id == 0x605) continue;
    receive(id, kReadDeviceType);
    ASSERT_THAT(sent(), IsEmpty()) << std::hex << id;
  }
}

TEST_F(DeviceTest, SdoRequestsHaveEightBytes) {
  receive(0x605, {0x40, 0x00, 0x10, 0});
  EXPECT_THAT(sent(), IsEmpty());
}

// --- any frames at all

class AnyFrames : public DeviceTest {
 protected:
  hal::CanFrame any_frame() {
    constexpr std::array<std::uint16_t, 12> kInteresting{0x000, 0x080, 0x605, 0x605, 0x605, 0x605,
                                                         0x605, 0x605, 0x205, 0x703, 0x705, 0x585};
    hal::CanFrame frame;
    const unsigned dice = random() % 16;
    frame.id = static_cast<std::uint16_t>(dice < 12 ? kInteresting[dice] : random() % 2048);
    frame.size = static_cast<std::uint8_t>(random() % 4 != 0 ? 8 : random() % 9);
    for (std::size_t i = 0; i < frame.size; ++i)
      frame.data[i] = static_cast<std::uint8_t>(random());
    if (frame.id == 0x605 && random() % 2 == 0) aim(frame);
    if (frame.id == 0x000 && random() % 2 == 0) frame = nmt();
    return frame;
  }

  std::mt19937 random;

 private:
  // At an object that exists, with a command that exists.
  void aim(hal::CanFrame& frame) {
    constexpr std::array<std::uint8_t, 10> kCommands{0x40, 0x23, 0x2B, 0x2F, 0x22,
                                                     0x21, 0xC6, 0xA4, 0xA3, 0xA2};
    constexpr std::array<std::uint16_t, 16> kPdoObjects{
        0x1400, 0x1401, 0x1402, 0x1600, 0x1601, 0x1602, 0x1800, 0x1801,
        0x1802, 0x1A00, 0x1A01, 0x1A02, 0x1400, 0x1600, 0x1800, 0x1A00};
    const Span<const Entry> rows = device.objects().rows();
    const std::uint16_t index = random() % 2 == 0 ? kPdoObjects[random() % kPdoObjects.size()]
                                                  : rows[random() % rows.size()].index;
    frame.size = 8;
    frame.data[0] = kCommands[random() % kCommands.size()];
    frame.data[1] = static_cast<std::uint8_t>(index);
    frame.data[2] = static_cast<std::uint8_t>(index >> 8U);
    frame.data[3] = static_cast<std::uint8_t>(random() % 10);
    if (random() % 2 == 0) frame.data[6] = frame.data[7] = 0;
  }
  hal::CanFrame nmt() {
    constexpr std::array<unsigned, 8> kCommands{0x01, 0x01, 0x01, 0x01, 0x80, 0x02, 0x81, 0x82};
    return frame(0x000, {kCommands[random() % kCommands.size()], 0});
  }
};

// A block upload is the longest answer there is: 127 segments. All else together is a few frames:
// three TPDOs, SYNC, heartbeat, boot-up, and what the queue of emergencies holds.
constexpr std::size_t kMostAnswers = 127 + 3 + 3 + 16 + 2;

class AnyFramesOf : public AnyFrames, public ::testing::WithParamInterface<unsigned> {};

TEST_P(AnyFramesOf, DeviceStaysAliveAndDoesNotBabble) {
  SCOPED_TRACE(::testing::Message() << "seed " << GetParam());
  random.seed(GetParam());
  for (int i = 0; i < 20'000; ++i) {
    device.receive(any_frame(), now_us);
    now_us += random() % 3000;
    device.poll(now_us);
    const bool port_full = random() % 3 == 0;
    if (port_full) {
      refuse(1);
      continue;
    }
    const std::vector<hal::CanFrame> frames = sent();
    ASSERT_LE(frames.size(), kMostAnswers);
    for (const hal::CanFrame& frame : frames) {
      ASSERT_LE(frame.size, 8);
      ASSERT_LE(frame.id, hal::kMaxCanId);
    }
  }
  receive(0x000, {0x81, kNode});
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
  receive(0x605, kReadDeviceType);
  EXPECT_THAT(sent(), ElementsAre(frame(0x585, kDeviceType)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, AnyFramesOf, ::testing::Range(1U, 21U));

}  // namespace
}  // namespace volcomp::canopen::test
