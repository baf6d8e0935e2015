#pragma once
// One file that takes its place when it is complete, and not before.

#include <filesystem>
#include <fstream>
#include <string_view>

namespace volcomp::host {

// The file behind a chain of symbolic links, there or not. A descriptor of a process (/dev/fd/3)
// stays a link: what is open need not have a name.
[[nodiscard]] std::filesystem::path file_behind(const std::filesystem::path& path);

// Whether no file may take this place: a device, a pipe, a socket, a descriptor. They are written
// as standard output is.
[[nodiscard]] bool is_written_directly(const std::filesystem::path& path);

// Throws UserError naming the file where a draft of it would, without writing anything: so that
// what takes long is not done in vain.
void require_place(const std::filesystem::path& path);

// Written beside its place with the mode of the file that is there; gone unless it was put in
// place. All throw UserError naming the file, also where it may not be written.
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
  // Nothing is written after it.
  void complete();
  void put_in_place();

 private:
  void open_beside();
  void discard() const;

  std::filesystem::path path_;       // as the user says it
  std::filesystem::path place_;      // without links
  std::filesystem::path temporary_;  // empty: written directly, or put in place
  std::ofstream stream_;
};

}  // namespace volcomp::host
