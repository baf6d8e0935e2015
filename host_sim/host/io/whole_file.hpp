#pragma once
// Files appear whole or not at all.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/host/io/file_draft.hpp"

namespace volcomp::host {

// All of a file. Throws UserError naming it: cannot be opened, cannot be read, more than `largest`
// bytes.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& path, std::size_t largest);

// Writes beside the target and renames; throws UserError naming the file. An earlier file survives
// a failure.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

struct NamedText {
  std::string name;
  std::string text;
};

// Several files: none is put in place before all are written. Files that were not put in place are
// removed, with the folders made for them. All throw UserError naming the file or the folder.
class WholeFiles {
 public:
  WholeFiles() = default;
  ~WholeFiles();
  WholeFiles(const WholeFiles&) = delete;
  WholeFiles& operator=(const WholeFiles&) = delete;

  // With those above it.
  void add_folder(const std::filesystem::path& path);
  void add(const std::filesystem::path& path, std::string_view text);
  void put_in_place();

 private:
  struct Direct {
    std::filesystem::path path;
    std::string text;
  };
  std::vector<FileDraft> drafts_;
  std::vector<Direct> direct_;                      // nothing of these can be taken back
  std::vector<std::filesystem::path> new_folders_;  // innermost first
  std::vector<std::unique_ptr<RemovedBySignal>> removals_;
};

// Throws UserError naming the folder where none could be made, or nothing be written into it,
// without making it.
void require_folder(const std::filesystem::path& path);

// With those above it; one that exists is fine. Throws UserError naming it.
void create_folder(const std::filesystem::path& path);

}  // namespace volcomp::host
