#pragma once
// What a drive lets into its PDOs: the mappings that the ways of the node need, and what the drive
// said when each was tried.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/canopen/pdo.hpp"

namespace volcomp::host {

// Entries as 16xxh and 1Axxh hold them.
using Mapping = std::vector<std::uint32_t>;

inline constexpr std::uint32_t kOffsetEntry = canopen::mapped(0x60B0, 0, 32);
inline constexpr std::uint32_t kControlEntry = canopen::mapped(0x6040, 0, 16);
inline constexpr std::uint32_t kTargetEntry = canopen::mapped(0x607A, 0, 32);
inline constexpr std::uint32_t kStatusEntry = canopen::mapped(0x6041, 0, 16);
inline constexpr std::uint32_t kActualEntry = canopen::mapped(0x6064, 0, 32);
inline constexpr std::uint32_t kModeEntry = canopen::mapped(0x6061, 0, 8);
// Placeholders of an RPDO: four bytes, and one.
inline constexpr std::uint32_t kFourByteDummy = canopen::mapped(0x0007, 0, 32);
inline constexpr std::uint32_t kOneByteDummy = canopen::mapped(0x0005, 0, 8);

// Transmission type 1: values of SYNC.
inline constexpr std::uint8_t kEverySync = 1;

// 6040h out of a frame {6040h, 607Ah}: alone, or with placeholders to its six bytes.
[[nodiscard]] inline Mapping control_alone() { return {kControlEntry}; }
[[nodiscard]] inline Mapping control_and_four_bytes() { return {kControlEntry, kFourByteDummy}; }
[[nodiscard]] inline Mapping control_and_single_bytes() {
  return {kControlEntry, kOneByteDummy, kOneByteDummy, kOneByteDummy, kOneByteDummy};
}

struct MappingAnswer {
  canopen::PdoKind kind = canopen::PdoKind::receive;
  Mapping entries;
  canopen::AbortCode why = canopen::AbortCode::none;  // none: taken, and read back

  [[nodiscard]] bool taken() const { return why == canopen::AbortCode::none; }
};

struct TriedMappings {
  std::size_t rpdo = 0;  // that were used for it, from 1
  std::size_t tpdo = 0;
  std::vector<MappingAnswer> answers;
  bool rpdo_at_sync = false;  // transmission type 1 was taken
  bool tpdo_at_sync = false;
  std::vector<std::string> notes;  // on what did not take its old value, a sentence each

  // Nothing: not tried.
  [[nodiscard]] std::optional<bool> took(canopen::PdoKind kind, const Mapping& entries) const {
    for (const MappingAnswer& answer : answers) {
      if (answer.kind == kind && answer.entries == entries) return answer.taken();
    }
    return std::nullopt;
  }
};

// "6040h, 0007h".
[[nodiscard]] std::string mapping_text(const Mapping& entries);

}  // namespace volcomp::host
