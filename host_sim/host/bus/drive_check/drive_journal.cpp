#include "host_sim/host/bus/drive_check/drive_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "comp/core/crc32.hpp"
#include "host_sim/host/bus/drive_check/journal_lines.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"

namespace volcomp::host {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargest = std::size_t{1} << 20U;
constexpr const char* kEnding = ".journal";

[[noreturn]] void refuse(const fs::path& path, const char* what) {
  throw UserError(fmt::format("{}: {}", path.string(), what));
}

// Not every file system knows it.
bool has_reached_disk(int file) {
  return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

// The name of a file is on the disk when its folder is.
bool folder_has_reached_disk(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return false;
  const bool done = has_reached_disk(file);
  ::close(file);
  return done;
}

// Where there is no such lock, nobody can be kept out.
bool lock(int file) { return ::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

}  // namespace

DriveJournal DriveJournal::create(const fs::path& path, const JournalOwner& owner) {
  if (path.has_parent_path()) create_folder(path.parent_path());
  const int file =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0)
    refuse(path, errno == EEXIST ? "is there already: it may be the journal of another drive"
                                 : "cannot be written");
  DriveJournal journal(path, file);
  if (!lock(file)) refuse(path, "another command works with this drive");
  journal.content_.owner = owner;
  journal.append(journal_lines::head(owner));
  if (!folder_has_reached_disk(path)) refuse(path, "cannot be put on the disk");
  return journal;
}

std::optional<DriveJournal> DriveJournal::open(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return std::nullopt;
  if (file < 0) refuse(path, "cannot be opened");
  DriveJournal journal(path, file);
  if (!lock(file)) refuse(path, "another command works with this drive");
  const std::string text = read_whole_file(path, kLargest);
  auto content = read_journal(text);
  if (!content || content->objects.empty()) {
    if (!journal_lines::may_be_one(text)) refuse(path, "is no journal of a drive");
    journal.remove();
    return std::nullopt;
  }
  journal.content_ = std::move(*content);
  // What comes after a torn line would not be read.
  if (::ftruncate(file, static_cast<off_t>(journal_lines::whole_bytes(text))) != 0)
    refuse(path, "cannot be written");
  return journal;
}

DriveJournal::DriveJournal(DriveJournal&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      content_(std::move(other.content_)) {}

DriveJournal::~DriveJournal() {
  if (file_ >= 0) ::close(file_);
}

const KeptObject* DriveJournal::find(canopen::ObjectId object) const {
  const auto found = std::find_if(content_.objects.begin(), content_.objects.end(),
                                  [object](const KeptObject& k) { return k.object == object; });
  return found == content_.objects.end() ? nullptr : &*found;
}

void DriveJournal::keep(const std::vector<KeptObject>& objects) {
  std::string lines;
  std::vector<KeptObject> added;
  for (const KeptObject& object : objects) {
    if (find(object.object) != nullptr) continue;
    lines += journal_lines::before(object.object, object.before);
    added.push_back({object.object, object.before, {}});
  }
  if (added.empty()) return;
  append(lines);
  content_.objects.insert(content_.objects.end(), added.begin(), added.end());
}

void DriveJournal::announce(canopen::ObjectId object, const SdoChannel::Bytes& value) {
  const auto kept = std::find_if(content_.objects.begin(), content_.objects.end(),
                                 [object](const KeptObject& k) { return k.object == object; });
  if (kept == content_.objects.end()) refuse(path_, "an object is written that was not kept");
  if (std::find(kept->written.begin(), kept->written.end(), value) != kept->written.end()) return;
  append(journal_lines::after(object, value));
  kept->written.push_back(value);
}

void DriveJournal::append(const std::string& lines) const {
  const ssize_t written = ::write(file_, lines.data(), lines.size());
  if (written != static_cast<ssize_t>(lines.size()) || !has_reached_disk(file_))
    refuse(path_, "cannot be written; the drive is not");
}

void DriveJournal::remove() {
  std::error_code failed;
  fs::remove(path_, failed);
  if (failed || !folder_has_reached_disk(path_)) refuse(path_, "cannot be removed");
}

fs::path journal_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  // The XDG specification lets a relative path count as none.
  if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "volcomp";
  const char* const home = std::getenv("HOME");
  if (home == nullptr || !fs::path(home).is_absolute())
    throw UserError("neither XDG_STATE_HOME nor HOME is set: say with --journal where it goes");
  return fs::path(home) / ".local/state/volcomp";
}

std::string journal_name(const std::string& bus, std::uint8_t node) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  if (!bus.empty() && bus.size() < 16 && std::all_of(bus.begin(), bus.end(), plain))
    return fmt::format("{}-{}{}", bus, node, kEnding);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(bus.data());
  return fmt::format("bus-{:08x}-{}{}", crc32({bytes, bus.size()}), node, kEnding);
}

std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == kEnding) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace volcomp::host
