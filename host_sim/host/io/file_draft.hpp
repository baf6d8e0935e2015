#pragma once
// One file that takes its place when it is complete, and not before.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "host_sim/host/io/interruption.hpp"

namespace volcomp::host {

// "-" or "/dev/stdout". Two results there, or a result and text, would write over each other.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& path);

// Names a result in messages: its path, or "standard output".
[[nodiscard]] std::string shown_output(const std::filesystem::path& path);

// The file behind a chain of symbolic links, there or not. A descriptor of a process (/dev/fd/3)
// stays a link: what is open need not have a name.
[[nodiscard]] std::filesystem::path file_behind(const std::filesystem::path& path);

// Whether no file may take this place: a device, a pipe, a socket, a descriptor, standard output.
[[nodiscard]] bool is_written_directly(const std::filesystem::path& path);

// Throws UserError naming the file where a draft of it would, without writing anything: so that
// what takes long is not done in vain.
void require_place(const std::filesystem::path& path);

// Written beside its place with the mode of the file that is there; removed unless it was put in
// place, also when a signal ends the program. All throw UserError naming the file, also where it
// may not be written.
class FileDraft {
 public:
  explicit FileDraft(const std::filesystem::path& path);
  ~FileDraft() { discard(); }
  FileDraft(FileDraft&& other) noexcept;
  FileDraft(const FileDraft&) = delete;
  FileDraft& operator=(const FileDraft&) = delete;
  FileDraft& operator=(FileDraft&&) = delete;

  [[nodiscard]] bool is_beside() const { return !temporary_.empty(); }
  void write(std::string_view text);
  // Nothing is written after it. What is put in place then is on the disk: a power failure leaves
  // the earlier file or this one, not an empty one.
  void complete();
  void put_in_place();

 private:
  // Standard output stays open.
  static bool close(std::FILE* file);
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(close(file)); }
  };

  void open_beside();
  void discard();

  std::filesystem::path path_;       // as the user wrote it
  std::filesystem::path place_;      // without links
  std::filesystem::path temporary_;  // empty: written directly, or put in place
  std::unique_ptr<RemovedBySignal> removal_;
  std::unique_ptr<std::FILE, Close> stream_;
};

}  // namespace volcomp::host
