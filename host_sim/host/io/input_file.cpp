#include "host_sim/host/io/input_file.hpp"

#include <cerrno>
#include <iostream>
#include <system_error>

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// A pipe can be read only once.
void take_standard_input() {
  static bool taken = false;
  if (taken) throw UserError("only one file can come from standard input (-)");
  taken = true;
}

}  // namespace

std::string shown_name(const std::filesystem::path& path) {
  return path == kStandardStream ? "standard input" : path.string();
}

InputFile::InputFile(const std::filesystem::path& path) : name_(shown_name(path)) {
  if (path == kStandardStream) {
    take_standard_input();
    stream_ = &std::cin;
    return;
  }
  errno = 0;
  file_.open(path, std::ios::binary);
  const int why = errno;
  if (!file_ && why != 0)
    throw UserError(
        fmt::format("{}: cannot be opened: {}", name_, std::generic_category().message(why)));
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw UserError(name_ + ": cannot be opened: Is a directory");
  if (!file_) throw UserError(name_ + ": cannot be opened");
}

std::string InputFile::beginning(std::size_t most) {
  std::string text(most, '\0');
  stream_->read(text.data(), static_cast<std::streamsize>(most));
  if (stream_->bad()) throw UserError(name_ + ": cannot be read");
  text.resize(static_cast<std::size_t>(stream_->gcount()));
  return text;
}

}  // namespace volcomp::host
