#include "hal/mps2/flash_blocks.hpp"

#include <algorithm>
#include <array>
#include <atomic>

namespace volcomp::hal::mps2 {
namespace {

// Behind the sectors. What memory holds by chance after power on is not this.
constexpr std::array<std::uint8_t, FlashBlocks::kUnitBytes> kMark{
    'v', 'o', 'l', 'c', 'o', 'm', 'p', ' ', 'f', 'l', 'a', 's', 'h', ' ', 'm', 'o',
    'd', 'e', 'l', ',', ' ', '2', ' ', 'x', ' ', ' ', '6', '4', ' ', 'K', 'i', 'B'};

}  // namespace

bool FlashBlocks::attach(Span<std::uint8_t> memory) {
  memory_ = memory.size() < kMemoryBytes ? nullptr : memory.data();
  if (memory_ == nullptr) return false;
  if (used_before()) return true;
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    if (!erase(sector)) return false;
  }
  std::atomic_signal_fence(std::memory_order_seq_cst);  // a reset may come in between: mark last
  mark_used();
  return true;
}

bool FlashBlocks::used_before() const {
  return std::equal(kMark.begin(), kMark.end(), memory_ + kBytes);
}

void FlashBlocks::mark_used() { std::copy(kMark.begin(), kMark.end(), memory_ + kBytes); }

BlockRead FlashBlocks::read(std::size_t at, Span<std::uint8_t> out) const {
  if (memory_ == nullptr || !is_inside<FlashBlocks>(at, out.size())) return BlockRead::failed;
  std::copy_n(memory_ + at, out.size(), out.data());
  return BlockRead::done;
}

// program() and erase() change the memory, if not the object.
// NOLINTNEXTLINE(readability-make-member-function-const)
bool FlashBlocks::program(std::size_t at, Span<const std::uint8_t> bytes) {
  if (memory_ == nullptr || !is_whole_units<FlashBlocks>(at, bytes.size())) return false;
  if (!is_erased({memory_ + at, bytes.size()})) return false;
  std::copy_n(bytes.data(), bytes.size(), memory_ + at);
  return true;
}

// NOLINTNEXTLINE(readability-make-member-function-const)
bool FlashBlocks::erase(std::size_t sector) {
  if (memory_ == nullptr || sector >= kSectors) return false;
  std::fill_n(memory_ + sector * kSectorBytes, kSectorBytes, kErasedByte);
  return true;
}

}  // namespace volcomp::hal::mps2
