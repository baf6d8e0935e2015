#pragma once
// The lines of a journal (drive_journal.hpp), each with its CRC-32:
//
//   volcomp-drive-journal 1 5f3c2a10
//   bus can0 …
//   drive 3 0000009a 00030924 00010420 00000000 …     node id, then 1018h:01 to :04
//   before 1603 00 02 …                                index, sub-index, bytes as they go over SDO
//   after 1603 00 00 …

#include <cstddef>
#include <string>
#include <string_view>

#include "host_sim/host/bus/drive_check/drive_journal.hpp"

namespace volcomp::host::journal_lines {

[[nodiscard]] std::string head(const JournalOwner& owner);
[[nodiscard]] std::string before(canopen::ObjectId object, const SdoChannel::Bytes& value);
[[nodiscard]] std::string after(canopen::ObjectId object, const SdoChannel::Bytes& value);

// How many bytes from the beginning are whole lines.
[[nodiscard]] std::size_t whole_bytes(std::string_view text);
// Whether a text begins as a journal does, perhaps torn: no other file is to be removed.
[[nodiscard]] bool may_be_one(std::string_view text);

}  // namespace volcomp::host::journal_lines
