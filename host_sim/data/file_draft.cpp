#include "host_sim/data/file_draft.hpp"

#include <unistd.h>

#include <utility>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
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

// root may write everything: a file without any permission to write stays as it is all the same.
bool may_be_replaced(const fs::path& file, fs::perms mode) {
  constexpr fs::perms kAnyWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  return (mode & kAnyWrite) != fs::perms::none && ::access(file.c_str(), W_OK) == 0;
}

}  // namespace

fs::path file_behind(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as Linux
  fs::path file = path;
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && is_link(file) && !is_link_to_descriptor(file); ++i)
    file = file.parent_path() / fs::read_symlink(file, ignored);
  return file;
}

bool is_written_directly(const fs::path& path) {
  if (is_link(file_behind(path))) return true;  // a descriptor; a circle, which cannot be opened
  std::error_code ignored;
  return fs::is_other(path, ignored);
}

FileDraft::FileDraft(const fs::path& path) : path_(path), place_(file_behind(path)) {
  if (is_written_directly(path)) {
    stream_.open(path, std::ios::binary);
  } else {
    open_beside();
  }
  if (stream_) return;
  discard();
  fail();
}

FileDraft::FileDraft(FileDraft&& other) noexcept
    : path_(std::move(other.path_)),
      place_(std::move(other.place_)),
      temporary_(std::exchange(other.temporary_, {})),
      stream_(std::move(other.stream_)) {}

void FileDraft::open_beside() {
  std::error_code failed;
  const fs::file_status there = fs::status(place_, failed);
  const bool replaces = fs::exists(there);
  if (fs::is_directory(there) || (replaces && !may_be_replaced(place_, there.permissions())))
    fail();
  temporary_ = place_;
  temporary_ += fmt::format(".{}.tmp", ::getpid());
  stream_.open(temporary_, std::ios::binary);
  // Before there is anything in it to be read.
  if (stream_ && replaces) fs::permissions(temporary_, there.permissions(), failed);
}

void FileDraft::write(std::string_view text) {
  stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream_) fail();
}

void FileDraft::complete() {
  stream_.close();
  if (!stream_) fail();
}

void FileDraft::put_in_place() {
  if (temporary_.empty()) return;
  std::error_code failed;
  fs::rename(temporary_, place_, failed);
  if (failed) fail();
  temporary_.clear();
}

void FileDraft::discard() const {
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void FileDraft::fail() const {
  throw UserError(fmt::format("{}: cannot be written", path_.string()));
}

}  // namespace volcomp::sim
