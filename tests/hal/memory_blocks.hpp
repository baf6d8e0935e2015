#pragma once
// The block device of hal/block_device.hpp in memory, for tests: flash with error correction that
// loses power, reports failures or wears out wherever a test wants it to. Operations, one per unit
// programmed and one per sector erased, are what is counted and cut.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include "hal/block_device.hpp"

namespace volcomp::test {

// What an operation that was cut short leaves in its unit or sector. `done` is what it would have
// left at its end, `erased` what a unit holds before it is programmed.
enum class Torn : std::uint8_t {
  untouched,      // as before: it had not begun
  front,          // the first half done, the second as before
  back,           // the second half done, the first as before
  some_bits,      // every other bit done
  cleared,        // all zero: NOR flash programs a sector to zero before it erases it
  random,         // any bits
  uncorrectable,  // any bits, and the error correction reports it
  unstable,  // each read differs: erased, done, in between or uncorrectable. A sector never reads
             // as before: it was programmed to zero first
  complete,  // done, but not reported
};
inline constexpr std::array<Torn, 9> kEveryTorn{
    Torn::untouched, Torn::front,         Torn::back,     Torn::some_bits, Torn::cleared,
    Torn::random,    Torn::uncorrectable, Torn::unstable, Torn::complete};

template <std::size_t SectorBytes, std::size_t Sectors, std::size_t UnitBytes = 32>
class MemoryBlocks {
 public:
  static constexpr std::size_t kUnitBytes = UnitBytes;
  static constexpr std::size_t kSectorBytes = SectorBytes;
  static constexpr std::size_t kSectors = Sectors;
  static constexpr std::size_t kBytes = SectorBytes * Sectors;
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  MemoryBlocks() { bytes_.fill(hal::kErasedByte); }

  // --- what goes wrong

  // Operation n from now, 0 the next, is cut short like this; then nothing answers until
  // power_on().
  void cut_power_at(std::size_t n, Torn torn) { cut_ = {operations_ + n, torn, true}; }
  // Likewise, but the device only reports a failure.
  void fail_at(std::size_t n, Torn torn) { cut_ = {operations_ + n, torn, false}; }
  void power_on() {
    powered_ = true;
    cut_ = {};
  }
  // From now on, until taken back.
  void refuse_erases(bool refuse) { refuse_erases_ = refuse; }
  void refuse_programs(bool refuse) { refuse_programs_ = refuse; }
  void refuse_reads(std::size_t sector, bool refuse) { refuse_reads_[sector] = refuse; }
  // Bits that stay 1 whatever is programmed.
  void set_stuck_bits(std::uint8_t bits) { stuck_bits_ = bits; }
  // Bits of one byte change on their own, beyond what error correction notices.
  void flip(std::size_t at, std::uint8_t bits) { bytes_[at] ^= bits; }
  // The bits that `random` and `unstable` draw.
  void seed(unsigned value) { draw_.seed(value + 1U); }

  // --- what a test looks at

  [[nodiscard]] bool powered() const { return powered_; }
  // Operations finished since the beginning.
  [[nodiscard]] std::size_t operations() const { return operations_; }
  // Calls refused because they broke the rules of hal/block_device.hpp: mistakes of the caller.
  [[nodiscard]] std::size_t misuses() const { return misuses_; }
  [[nodiscard]] const std::array<std::uint8_t, kBytes>& content() const { return bytes_; }

  // --- the block device

  hal::BlockRead read(std::size_t at, Span<std::uint8_t> out) {
    const bool allowed = count_misuse_unless(hal::is_inside<MemoryBlocks>(at, out.size()));
    if (!powered_ || !allowed) return hal::BlockRead::failed;
    hal::BlockRead result = hal::BlockRead::done;
    for (std::size_t i = 0; i < out.size();) {
      const std::size_t here = at + i;
      if (refuse_reads_[here / SectorBytes]) return hal::BlockRead::failed;
      const std::size_t count = std::min(UnitBytes - here % UnitBytes, out.size() - i);
      if (!read_unit(here, {&out[i], count})) result = hal::BlockRead::uncorrectable;
      i += count;
    }
    return result;
  }

  bool program(std::size_t at, Span<const std::uint8_t> bytes) {
    const bool allowed = count_misuse_unless(hal::is_whole_units<MemoryBlocks>(at, bytes.size()) &&
                                             never_programmed(at, bytes.size()));
    if (!powered_ || refuse_programs_ || !allowed) return false;
    for (std::size_t i = 0; i < bytes.size(); i += UnitBytes) {
      const std::size_t unit = (at + i) / UnitBytes;
      unit_[unit] = Unit::programmed;
      std::array<std::uint8_t, UnitBytes> done{};
      std::transform(bytes.begin() + i, bytes.begin() + i + UnitBytes, done.begin(),
                     [this](auto byte) { return static_cast<std::uint8_t>(byte | stuck_bits_); });
      const bool whole = !cut_here();
      if (!whole && cut_.torn == Torn::untouched) unit_[unit] = Unit::erased;
      leave(unit, whole ? Torn::complete : cut_.torn, done);
      if (!whole) return fail();
      ++operations_;
    }
    return true;
  }

  bool erase(std::size_t sector) {
    const bool allowed = count_misuse_unless(sector < Sectors);
    if (!powered_ || refuse_erases_ || !allowed) return false;
    const bool whole = !cut_here();
    const Torn torn = whole ? Torn::complete : cut_.torn;
    for (std::size_t i = 0; i < kUnitsPerSector; ++i)
      erase_unit(sector * kUnitsPerSector + i, half_of(torn, i));
    if (!whole) return fail();
    ++operations_;
    return true;
  }

 private:
  static constexpr std::size_t kUnitsPerSector = SectorBytes / UnitBytes;
  using UnitContent = std::array<std::uint8_t, UnitBytes>;

  enum class Unit : std::uint8_t { erased, programmed, uncorrectable, unstable };
  struct Cut {
    std::size_t at = kNever;
    Torn torn = Torn::untouched;
    bool power = false;
  };

  bool count_misuse_unless(bool right) {
    misuses_ += right ? 0U : 1U;
    return right;
  }
  bool never_programmed(std::size_t at, std::size_t size) const {
    const Unit* const first = unit_.data() + at / UnitBytes;
    return std::all_of(first, first + size / UnitBytes,
                       [](Unit unit) { return unit == Unit::erased; });
  }

  [[nodiscard]] bool cut_here() const { return operations_ == cut_.at; }
  bool fail() {
    powered_ = !cut_.power;
    cut_ = {};
    return false;
  }

  std::uint8_t random_byte() { return static_cast<std::uint8_t>(draw_() >> 8U); }

  // For a sector the halves are halves of the sector.
  static Torn half_of(Torn torn, std::size_t unit) {
    if (torn != Torn::front && torn != Torn::back) return torn;
    const bool in_front = unit < kUnitsPerSector / 2;
    return in_front == (torn == Torn::front) ? Torn::complete : Torn::untouched;
  }

  void erase_unit(std::size_t unit, Torn torn) {
    if (torn == Torn::untouched) return;
    unit_[unit] = torn == Torn::complete ? Unit::erased : Unit::programmed;
    UnitContent done{};
    done.fill(torn == Torn::unstable ? std::uint8_t{0} : hal::kErasedByte);
    leave(unit, torn, done);
  }

  void leave(std::size_t unit, Torn torn, const UnitContent& done) {
    std::uint8_t* const bytes = bytes_.data() + unit * UnitBytes;
    for (std::size_t i = 0; i < UnitBytes; ++i)
      bytes[i] = torn_byte(torn, bytes[i], done[i], i < UnitBytes / 2);
    if (torn == Torn::uncorrectable) unit_[unit] = Unit::uncorrectable;
    if (torn == Torn::unstable) unit_[unit] = Unit::unstable;
  }

  std::uint8_t torn_byte(Torn torn, std::uint8_t before, std::uint8_t done, bool in_front) {
    constexpr unsigned kSome = 0x55;
    switch (torn) {
      case Torn::untouched:
        return before;
      case Torn::front:
        return in_front ? done : before;
      case Torn::back:
        return in_front ? before : done;
      case Torn::some_bits:
        return static_cast<std::uint8_t>((before & ~kSome) | (done & kSome));
      case Torn::cleared:
        return 0;
      case Torn::random:
      case Torn::uncorrectable:
        return random_byte();
      case Torn::unstable:
      case Torn::complete:
        return done;
    }
    return done;
  }

  // False: uncorrectable.
  bool read_unit(std::size_t at, Span<std::uint8_t> out) {
    const Unit unit = unit_[at / UnitBytes];
    std::copy_n(bytes_.data() + at, out.size(), out.data());
    if (unit != Unit::unstable) return unit != Unit::uncorrectable;
    const unsigned outcome = draw_() % 4;
    for (std::uint8_t& byte : out) {
      if (outcome == 1) byte = hal::kErasedByte;
      if (outcome == 2) byte = static_cast<std::uint8_t>(byte | random_byte());
    }
    return outcome != 3;
  }

  std::array<std::uint8_t, kBytes> bytes_;
  std::array<Unit, kBytes / UnitBytes> unit_{};
  std::array<bool, Sectors> refuse_reads_{};
  bool refuse_erases_ = false;
  bool refuse_programs_ = false;
  std::uint8_t stuck_bits_ = 0;
  Cut cut_{};
  std::size_t operations_ = 0;
  std::size_t misuses_ = 0;
  bool powered_ = true;
  std::minstd_rand draw_{1};
};

}  // namespace volcomp::test
