#pragma once
// A file to read, or standard input for "-": so that commands can stand in a pipe.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string>

namespace volcomp::host {

inline constexpr const char* kStandardStream = "-";

// For messages: the path, or "standard input".
[[nodiscard]] std::string shown_name(const std::filesystem::path& path);

class InputFile {
 public:
  // Throws UserError naming it: cannot be opened, or standard input was read before.
  explicit InputFile(const std::filesystem::path& path);

  [[nodiscard]] std::istream& stream() { return *stream_; }
  // All of it, or as many bytes. Throws UserError naming it when it cannot be read to there.
  [[nodiscard]] std::string beginning(std::size_t most);
  // For messages.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::ifstream file_;
  std::istream* stream_ = &file_;
  std::string name_;
};

}  // namespace volcomp::host
