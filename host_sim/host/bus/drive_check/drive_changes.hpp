#pragma once
// Writes objects of a drive, each only after its old value is in the journal.

#include <functional>
#include <utility>

#include "firmware/canopen/pdo.hpp"
#include "host_sim/host/bus/drive_check/drive_journal.hpp"
#include "host_sim/host/bus/drive_check/drive_restore.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

class DriveChanges {
 public:
  // Called before every SDO; what it throws ends the work.
  using Check = std::function<void()>;

  // Creates the journal when the first object is kept. `owner` must be of the drive of the client.
  DriveChanges(NodeClient& client, std::filesystem::path journal, JournalOwner owner,
               Check check = {});

  // All throw what the client throws, and UserError when the journal cannot be written.
  [[nodiscard]] std::uint64_t read(canopen::ObjectId object);
  // Keeps everything of a PDO that a change of its mapping concerns: COB-ID, type, count, entries.
  void keep(canopen::PdoKind kind, const ForeignPdo& pdo);
  // Little-endian, `bytes` long (1…4). An object that was not kept is read and kept first.
  void write(canopen::ObjectId object, std::uint32_t value, std::size_t bytes);

  // Runs `work`, then puts everything back and removes the journal, also when `work` has thrown.
  // Throws NotRestored, else what `work` has thrown.
  Restored run_and_restore(const std::function<void()>& work);
  // Runs `work`; what it has written stays. Everything is put back only when it throws.
  void run_or_restore(const std::function<void()>& work);

 private:
  void keep(canopen::ObjectId object, std::vector<KeptObject>& kept);
  void keep_now(const std::vector<KeptObject>& kept);
  Restored put_back();
  [[nodiscard]] SdoChannel::Bytes value_of(canopen::ObjectId object);

  NodeClient& client_;
  std::filesystem::path path_;
  JournalOwner owner_;
  Check check_;
  std::optional<DriveJournal> journal_;
};

// 14xxh or 18xxh, and 16xxh or 1Axxh, of a PDO (from 1).
[[nodiscard]] std::uint16_t communication_of(canopen::PdoKind kind, std::size_t number);
[[nodiscard]] std::uint16_t mapping_of(canopen::PdoKind kind, std::size_t number);

}  // namespace volcomp::host
