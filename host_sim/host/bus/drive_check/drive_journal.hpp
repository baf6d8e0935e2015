#pragma once
// What a tool changes in a drive for a while, kept on the disk: a later call puts it back when the
// tool was killed or the computer lost its power.
//
// A text file: a line for each value that is about to be overwritten and for each new one, with a
// CRC-32 at its end. A line is on the disk, and so is the name of the file, before the drive is
// written. So whatever was not written whole names no change: it is read up to the first bad line.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/canopen/object_access.hpp"
#include "host_sim/host/bus/sdo_channel.hpp"

namespace volcomp::host {

// Whose objects they are: node id and interface, and 1018h of the drive (0: it has no such value).
struct JournalOwner {
  std::string bus;  // as open_frame_link() takes it
  std::uint8_t node = 1;
  std::array<std::uint32_t, 4> identity{};  // vendor, product, revision, serial number
};

struct KeptObject {
  canopen::ObjectId object;
  SdoChannel::Bytes before;                // what it held at first
  std::vector<SdoChannel::Bytes> written;  // what this tool has put there since, or tried to
};

struct JournalContent {
  JournalOwner owner;
  std::vector<KeptObject> objects;  // in the order in which they were kept
};

// The text of a journal as far as it is whole; nothing when its owner is not.
[[nodiscard]] std::optional<JournalContent> read_journal(std::string_view text);

// An open journal. While it is open, no other process can open it.
class DriveJournal {
 public:
  // A new file; its folder is made if need be. Throws UserError naming it: it is there already, or
  // cannot be written.
  [[nodiscard]] static DriveJournal create(const std::filesystem::path& path,
                                           const JournalOwner& owner);
  // The one another call has left. Nothing: the file is gone, or no drive was changed. Throws
  // UserError when another process has it open, or it cannot be read.
  [[nodiscard]] static std::optional<DriveJournal> open(const std::filesystem::path& path);

  DriveJournal(DriveJournal&& other) noexcept;
  DriveJournal(const DriveJournal&) = delete;
  DriveJournal& operator=(const DriveJournal&) = delete;
  DriveJournal& operator=(DriveJournal&&) = delete;
  ~DriveJournal();  // closes; the file stays

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const JournalOwner& owner() const { return content_.owner; }
  [[nodiscard]] const std::vector<KeptObject>& objects() const { return content_.objects; }
  [[nodiscard]] const KeptObject* find(canopen::ObjectId object) const;

  // Before an object is written for the first time: what it holds. Several at once reach the disk
  // together. An object that is kept already stays as it is. Throw UserError naming the file when
  // it is not on the disk.
  void keep(const std::vector<KeptObject>& objects);
  // Before each write: the value to come. The object has been kept.
  void announce(canopen::ObjectId object, const SdoChannel::Bytes& value);

  // Everything is back, or is to stay: the file is removed.
  void remove();

 private:
  DriveJournal(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}
  void append(const std::string& lines) const;

  std::filesystem::path path_;
  int file_ = -1;
  JournalContent content_;
};

// $XDG_STATE_HOME/volcomp or ~/.local/state/volcomp. Throws UserError when neither is known.
[[nodiscard]] std::filesystem::path journal_folder();
// The name in that folder for a drive on a bus.
[[nodiscard]] std::string journal_name(const std::string& bus, std::uint8_t node);
// The journals in a folder, by name; none when there is no such folder.
[[nodiscard]] std::vector<std::filesystem::path> journals_in(const std::filesystem::path& folder);

}  // namespace volcomp::host
