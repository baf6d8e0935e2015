#include "host_sim/host/io/file_draft.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

namespace fs = std::filesystem;

bool is_link(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored);
}

bool is_link_to_descriptor(const fs::path& link) {
  std::error_code ignored;
  return fs::weakly_canonical(link.parent_path(), ignored).string().rfind("/proc/", 0) == 0;
}

// root may write everything, but a file without any permission to write stays unchanged.
bool may_be_taken(const fs::path& place, const fs::file_status& there) {
  constexpr fs::perms kAnyWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if (!fs::exists(there)) return true;
  return !fs::is_directory(there) && (there.permissions() & kAnyWrite) != fs::perms::none &&
         ::access(place.c_str(), W_OK) == 0;
}

[[noreturn]] void refuse(const fs::path& path) {
  throw UserError(shown_output(path) + ": cannot be written");
}

constexpr int kMostNames = 100;

fs::path name_beside(const fs::path& place, int attempt) {
  fs::path name = place;
  name += attempt == 0 ? fmt::format(".{}.tmp", ::getpid())
                       : fmt::format(".{}.{}.tmp", ::getpid(), attempt);
  return name;
}

// Creates a new file only: another user with write access to the folder, /tmp for instance, could
// have put a link there. The name may also be left from an earlier run with the same process id.
int create_beside(const fs::path& place, mode_t mode, fs::path& name) {
  for (int attempt = 0; attempt < kMostNames; ++attempt) {
    name = name_beside(place, attempt);
    const int file =
        ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

// Not every file system knows it.
bool is_on_the_disk(int file) {
  return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

}  // namespace

bool is_standard_output(const fs::path& path) {
  return path == kStandardStream || path == "/dev/stdout";
}

std::string shown_output(const fs::path& path) {
  return is_standard_output(path) ? "standard output" : path.string();
}

fs::path file_behind(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as Linux
  fs::path file = path;
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && is_link(file) && !is_link_to_descriptor(file); ++i)
    file = file.parent_path() / fs::read_symlink(file, ignored);
  return file;
}

bool is_written_directly(const fs::path& path) {
  if (is_standard_output(path)) return true;
  if (is_link(file_behind(path))) return true;  // a descriptor; a circle, which cannot be opened
  std::error_code ignored;
  return fs::is_other(path, ignored);
}

void require_place(const fs::path& path) {
  if (is_written_directly(path)) return;
  const fs::path place = file_behind(path);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : ".";
  std::error_code ignored;
  const bool lets_in = fs::is_directory(folder, ignored) && ::access(folder.c_str(), W_OK) == 0;
  if (!lets_in || !may_be_taken(place, fs::status(place, ignored))) refuse(path);
}

FileDraft::FileDraft(const fs::path& path) : path_(path), place_(file_behind(path)) {
  if (is_standard_output(path)) {
    stream_.reset(stdout);
  } else if (is_written_directly(path)) {
    stream_.reset(std::fopen(path.c_str(), "wbe"));
  } else {
    open_beside();
  }
  if (stream_) return;
  discard();
  refuse(path_);
}

FileDraft::FileDraft(FileDraft&& other) noexcept
    : path_(std::move(other.path_)),
      place_(std::move(other.place_)),
      temporary_(std::exchange(other.temporary_, {})),
      removal_(std::move(other.removal_)),
      stream_(std::move(other.stream_)) {}

void FileDraft::open_beside() {
  std::error_code failed;
  const fs::file_status there = fs::status(place_, failed);
  if (!may_be_taken(place_, there)) refuse(path_);
  const SignalsHeld until_registered;
  fs::path name;
  const int file = create_beside(place_, fs::exists(there) ? 0600 : 0666, name);
  if (file < 0) return;
  temporary_ = name;
  removal_ = std::make_unique<RemovedBySignal>(temporary_);
  // Before there is anything in it to be read.
  if (fs::exists(there))
    static_cast<void>(::fchmod(file, static_cast<mode_t>(there.permissions())));
  stream_.reset(::fdopen(file, "wb"));
  if (!stream_) ::close(file);
}

void FileDraft::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_.get()) != text.size()) refuse(path_);
}

void FileDraft::complete() {
  const bool flushed = std::fflush(stream_.get()) == 0 &&
                       (temporary_.empty() || is_on_the_disk(::fileno(stream_.get())));
  if (!close(stream_.release()) || !flushed) refuse(path_);
}

bool FileDraft::close(std::FILE* file) {
  return file == stdout ? std::ferror(file) == 0 : std::fclose(file) == 0;
}

void FileDraft::put_in_place() {
  if (temporary_.empty()) return;
  std::error_code failed;
  fs::rename(temporary_, place_, failed);
  if (failed) refuse(path_);
  temporary_.clear();
  removal_.reset();
}

void FileDraft::discard() {
  if (!temporary_.empty()) {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  removal_.reset();
}

}  // namespace volcomp::host
