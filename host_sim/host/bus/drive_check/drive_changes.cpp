#include "host_sim/host/bus/drive_check/drive_changes.hpp"

#include <exception>

#include "comp/core/bytes.hpp"

namespace volcomp::host {
namespace {

using canopen::ObjectId;
using canopen::PdoKind;
using canopen::PdoTable;
using Bytes = SdoChannel::Bytes;

}  // namespace

std::uint16_t communication_of(PdoKind kind, std::size_t number) {
  const unsigned first =
      kind == PdoKind::receive ? PdoTable::kReceiveCommunication : PdoTable::kTransmitCommunication;
  return static_cast<std::uint16_t>(first + number - 1);
}

std::uint16_t mapping_of(PdoKind kind, std::size_t number) {
  const unsigned first =
      kind == PdoKind::receive ? PdoTable::kReceiveMapping : PdoTable::kTransmitMapping;
  return static_cast<std::uint16_t>(first + number - 1);
}

DriveChanges::DriveChanges(NodeClient& client, std::filesystem::path journal, JournalOwner owner,
                           Check check)
    : client_(client),
      path_(std::move(journal)),
      owner_(std::move(owner)),
      check_(std::move(check)) {}

Bytes DriveChanges::value_of(ObjectId object) {
  if (check_) check_();
  return client_.read(object, 8, object_name(object));
}

std::uint64_t DriveChanges::read(ObjectId object) { return number(value_of(object)); }

void DriveChanges::keep(ObjectId object, std::vector<KeptObject>& kept) {
  if (journal_ && journal_->find(object) != nullptr) return;
  kept.push_back({object, value_of(object), {}});
}

void DriveChanges::keep_now(const std::vector<KeptObject>& kept) {
  if (!journal_) journal_.emplace(DriveJournal::create(path_, owner_));
  journal_->keep(kept);
}

// Entries beyond the count are kept when they are written.
void DriveChanges::keep(PdoKind kind, const ForeignPdo& pdo) {
  const std::uint16_t communication = communication_of(kind, pdo.number);
  const std::uint16_t mapping = mapping_of(kind, pdo.number);
  std::vector<KeptObject> kept;
  keep({communication, 1}, kept);
  keep({communication, 2}, kept);
  keep({mapping, 0}, kept);
  const std::uint64_t count = kept.empty() ? 0 : number(kept.back().before);
  for (std::uint64_t sub = 1; sub <= count && sub <= canopen::kMostMapped; ++sub)
    keep({mapping, static_cast<std::uint8_t>(sub)}, kept);
  keep_now(kept);
}

void DriveChanges::write(ObjectId object, std::uint32_t value, std::size_t bytes) {
  std::vector<KeptObject> kept;
  keep(object, kept);
  keep_now(kept);
  Bytes little_endian(bytes);
  store_le(little_endian.data(), bytes, value);
  journal_->announce(object, little_endian);
  if (check_) check_();
  client_.write(object, little_endian, object_name(object));
}

Restored DriveChanges::put_back() {
  if (!journal_) return {};
  Restored restored = restore(client_, journal_->objects());
  journal_->remove();
  journal_.reset();
  return restored;
}

Restored DriveChanges::run_and_restore(const std::function<void()>& work) {
  std::exception_ptr failure;
  try {
    work();
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  Restored restored = put_back();
  if (failure) std::rethrow_exception(failure);
  return restored;
}

void DriveChanges::run_or_restore(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception&) {
    static_cast<void>(put_back());
    throw;
  }
  if (journal_) journal_->remove();
  journal_.reset();
}

}  // namespace volcomp::host
