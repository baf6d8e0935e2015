#include "hal/mps2/instruction_counter.hpp"

#include <array>
#include <cstddef>

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {
namespace {

constexpr std::uint32_t kControl = 0xE000'E010;
constexpr std::uint32_t kReload = 0xE000'E014;
constexpr std::uint32_t kCurrent = 0xE000'E018;
constexpr std::uint32_t kMask = 0xFF'FFFF;
constexpr std::uint32_t kEnable = 1U << 0U;
constexpr std::uint32_t kProcessorClock = 1U << 2U;

constexpr std::size_t kReadings = 8;  // more than five
constexpr std::size_t kAllReadings = 16;
static_assert(kAllReadings == 2 * kReadings);

// Readings as far apart as the loop is long; and, where that is a multiple of five instructions,
// one more. In one of the two they hit every remainder of the count by five, since five is prime.
void take_readings(std::array<std::uint32_t, kAllReadings>& reading) {
  for (std::size_t i = 0; i < kReadings; ++i)
    reading[i] = InstructionCounter::ticks();
  for (std::size_t i = kReadings; i < kAllReadings; ++i) {
    reading[i] = InstructionCounter::ticks();
    __asm volatile("nop");
  }
}

}  // namespace

void InstructionCounter::start() {
  constexpr std::uint32_t kPhases = 5;
  device_register(kControl) = 0;
  device_register(kReload) = kMask;
  device_register(kCurrent) = 0;  // any write sets it to 0
  device_register(kControl) = kProcessorClock | kEnable;
  std::array<std::uint32_t, kAllReadings> readings{};
  take_readings(readings);
  std::uint32_t possible = (1U << kPhases) - 1U;
  for (const std::uint32_t reading : readings) {
    for (std::uint32_t phase = 0; phase < kPhases; ++phase) {
      if (!fits(reading, phase)) possible &= ~(1U << phase);
    }
  }
  exact_ = possible != 0 && (possible & (possible - 1U)) == 0;
  phase_ = exact_ ? static_cast<std::uint32_t>(__builtin_ctz(possible)) : 0U;
}

std::uint32_t InstructionCounter::ticks() { return kMask - device_register(kCurrent); }

std::uint32_t InstructionCounter::between(std::uint32_t from, std::uint32_t to) {
  constexpr std::uint32_t kWrap = (kMask + 1U) / 8U * 5U;
  const std::uint32_t before = instructions(from);
  const std::uint32_t after = instructions(to);
  return after >= before ? after - before : after + kWrap - before;
}

// The least I with 64·I + 8·phase ≥ 40·T.
std::uint32_t InstructionCounter::instructions(std::uint32_t ticks) {
  if (!fits(ticks, phase_)) exact_ = false;
  return (5U * ticks + 7U - phase_) / 8U;
}

}  // namespace volcomp::hal::mps2
