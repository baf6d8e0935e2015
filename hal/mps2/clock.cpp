#include "hal/mps2/clock.hpp"

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {
namespace {

constexpr std::uint32_t kValue = kDualTimer + 0x04;
constexpr std::uint32_t kControl = kDualTimer + 0x08;
constexpr std::uint32_t kFreeRunning32Bit = (1U << 7U) | (1U << 1U);

}  // namespace

void Clock::start() { device_register(kControl) = kFreeRunning32Bit; }

std::uint32_t clock_ticks() { return ~device_register(kValue); }  // it counts down

std::uint64_t Clock::now_us() const {
  const std::uint32_t now = clock_ticks();
  const std::uint32_t elapsed = now - last_;
  last_ = now;
  us_ += elapsed / kClock_MHz;
  fraction_ += elapsed % kClock_MHz;
  if (fraction_ >= kClock_MHz) {
    fraction_ -= kClock_MHz;
    ++us_;
  }
  return us_;
}

}  // namespace volcomp::hal::mps2
