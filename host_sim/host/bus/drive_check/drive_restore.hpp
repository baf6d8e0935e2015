#pragma once
// Puts back what a tool has changed in a drive, by the old values that were kept
// (drive_journal.hpp).

#include <cstdint>
#include <string>
#include <vector>

#include "host_sim/host/bus/drive_check/drive_journal.hpp"
#include "host_sim/host/bus/node_client.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

// "1603h:00".
[[nodiscard]] std::string object_name(canopen::ObjectId object);

struct SdoWrite {
  canopen::ObjectId object;
  SdoChannel::Bytes value;
};
// "1603h:00 = 02h".
[[nodiscard]] std::string describe(const SdoWrite& write);

// The drive is not as it was found; the journal stays.
struct NotRestored : UserError {
  NotRestored(const std::string& text, std::vector<SdoWrite> by)
      : UserError(text), writes(std::move(by)) {}
  std::vector<SdoWrite> writes;  // that restore it, in this order
};

// What was done.
struct Restored {
  std::size_t objects = 0;         // written back
  std::vector<std::string> notes;  // a sentence each: what was left as it is, and why
};

// The writes that restore the kept objects: the last one changed comes first, but a PDO is put back
// in the order that CiA 301 prescribes (7.5.2.36): invalid, count 0, entries, count; its COB-ID
// last.
[[nodiscard]] std::vector<SdoWrite> restoring_writes(const std::vector<KeptObject>& objects);

// Writes back what still holds a value of the tool, and compares. Objects that somebody else has
// written since are left alone, a PDO as a whole. Throws NotRestored.
Restored restore(NodeClient& client, const std::vector<KeptObject>& objects);

// Of the journal that another call has left: only if it is that drive (1018h) and it is not
// enabled. Throws NotRestored; removes the journal otherwise.
Restored restore(NodeClient& client, DriveJournal& journal);

}  // namespace volcomp::host
