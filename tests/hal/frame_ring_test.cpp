// Frames between two contexts: order, capacity, and two threads at once.

#include "hal/frame_ring.hpp"

#include <thread>

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::CanFrame;

TEST(FrameRing, HoldsItsCapacityAndKeepsTheOldest) {
  hal::FrameRing<8> ring;
  CanFrame f;
  EXPECT_FALSE(ring.pop(f));
  for (std::uint16_t id = 0; id < 8; ++id)
    EXPECT_TRUE(ring.push(frame(id)));
  EXPECT_FALSE(ring.push(frame(8)));
  for (std::uint16_t id = 0; id < 8; ++id) {
    ASSERT_TRUE(ring.pop(f));
    EXPECT_EQ(f.id, id);
  }
  EXPECT_FALSE(ring.pop(f));
}

TEST(FrameRing, NothingIsLostBetweenTwoThreads) {
  constexpr std::uint32_t kFrames = 20'000;
  hal::FrameRing<16> ring;
  std::thread producer([&ring] {
    for (std::uint32_t n = 0; n < kFrames; ++n) {
      CanFrame f = frame(static_cast<std::uint16_t>(n % 0x800), {static_cast<std::uint8_t>(n)});
      while (!ring.push(f))
        std::this_thread::yield();
    }
  });
  std::uint32_t wrong = 0;
  for (std::uint32_t n = 0; n < kFrames; ++n) {
    CanFrame f;
    while (!ring.pop(f))
      std::this_thread::yield();
    wrong += f.id != n % 0x800 || f.data[0] != static_cast<std::uint8_t>(n) ? 1U : 0U;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace volcomp::test
