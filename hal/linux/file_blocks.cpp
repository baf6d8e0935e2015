#include "hal/linux/file_blocks.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <string_view>

namespace volcomp::hal {
namespace {

constexpr std::size_t kChunkBytes = 1024;  // on the stack
using Chunk = std::array<std::uint8_t, kChunkBytes>;

// The system may move fewer bytes than requested; every round moves at least one.
bool read_all(int descriptor, std::size_t at, Span<std::uint8_t> out) {
  for (std::size_t done = 0; done < out.size();) {
    const ssize_t n =
        ::pread(descriptor, out.data() + done, out.size() - done, static_cast<off_t>(at + done));
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

bool write_all(int descriptor, std::size_t at, Span<const std::uint8_t> bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::pwrite(descriptor, bytes.data() + done, bytes.size() - done,
                               static_cast<off_t>(at + done));
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// Opens the folder of a file. No path is longer than PATH_MAX: open(2) has taken the file's.
int open_folder_of(std::string_view path) {
  std::array<char, PATH_MAX> folder{"."};
  const std::size_t slash = path.rfind('/');
  const std::size_t length = slash == 0 ? 1 : slash;
  if (slash != std::string_view::npos) {
    if (length >= folder.size()) return -1;
    path.copy(folder.data(), length);
    folder[length] = '\0';
  }
  return ::open(folder.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

// A file is on the medium, but not its name, until its folder is written, too (fsync(2)). EINVAL:
// a file system that knows no such thing.
bool sync_folder_of(const char* path) {
  const int folder = open_folder_of(path);
  if (folder < 0) return false;
  const bool synced = ::fsync(folder) == 0 || errno == EINVAL;
  const int error = errno;
  static_cast<void>(::close(folder));
  errno = error;
  return synced;
}

}  // namespace

OpenStatus FileBlocks::open(const char* path) {
  close();
  const OpenStatus status = attach(path);
  if (!status.ok()) close();
  return status;
}

OpenStatus FileBlocks::attach(const char* path) {
  if (!open_file(path)) return {OpenResult::failed, errno};
  // Some network file systems know no locks; only a lock held by another process is a reason to
  // stop.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return {OpenResult::in_use, errno};
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) return {OpenResult::failed, errno};
  if (!S_ISREG(info.st_mode)) return {OpenResult::wrong_size, 0};
  if (info.st_size == 0) return create(path);
  return info.st_size == off_t{kBytes} ? OpenStatus{} : OpenStatus{OpenResult::wrong_size, 0};
}

// The reason for which it cannot be written counts where it cannot be read, either.
bool FileBlocks::open_file(const char* path) {
  descriptor_ = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  const int error = errno;
  read_only_ = descriptor_ < 0 && (error == EROFS || error == EACCES || error == EPERM);
  if (read_only_) descriptor_ = ::open(path, O_RDONLY | O_CLOEXEC);
  errno = error;
  return descriptor_ >= 0;
}

// The name first: if that fails, the file is still empty and the next start tries again.
OpenStatus FileBlocks::create(const char* path) {
  if (read_only_) return {OpenResult::failed, EROFS};
  if (!sync_folder_of(path)) return {OpenResult::failed, errno};
  if (::ftruncate(descriptor_, off_t{kBytes}) != 0) return {OpenResult::failed, errno};
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    if (!erase(sector)) return {OpenResult::failed, errno};
  }
  return {};
}

void FileBlocks::close() {
  if (descriptor_ >= 0) static_cast<void>(::close(descriptor_));
  descriptor_ = -1;
  read_only_ = false;
}

BlockRead FileBlocks::read(std::size_t at, Span<std::uint8_t> out) const {
  const bool done =
      is_inside<FileBlocks>(at, out.size()) && descriptor_ >= 0 && read_all(descriptor_, at, out);
  return done ? BlockRead::done : BlockRead::failed;
}

// program() and erase() change the file, if not the object.
// NOLINTNEXTLINE(readability-make-member-function-const)
bool FileBlocks::program(std::size_t at, Span<const std::uint8_t> bytes) {
  if (!is_whole_units<FileBlocks>(at, bytes.size()) || descriptor_ < 0) return false;
  if (!all_erased(at, bytes.size())) return false;
  return write_all(descriptor_, at, bytes) && ::fdatasync(descriptor_) == 0;
}

// NOLINTNEXTLINE(readability-make-member-function-const)
bool FileBlocks::erase(std::size_t sector) {
  if (sector >= kSectors || descriptor_ < 0) return false;
  Chunk erased{};
  erased.fill(kErasedByte);
  for (std::size_t at = 0; at < kSectorBytes; at += kChunkBytes) {
    if (!write_all(descriptor_, sector * kSectorBytes + at, {erased.data(), erased.size()}))
      return false;
  }
  return ::fdatasync(descriptor_) == 0;
}

bool FileBlocks::all_erased(std::size_t at, std::size_t size) const {
  Chunk present{};
  for (std::size_t done = 0; done < size; done += kChunkBytes) {
    const std::size_t n = std::min(kChunkBytes, size - done);
    if (!read_all(descriptor_, at + done, {present.data(), n})) return false;
    if (!is_erased({present.data(), n})) return false;
  }
  return true;
}

}  // namespace volcomp::hal
