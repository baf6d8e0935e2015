#include "host_sim/host/io/toml_text.hpp"

#include <algorithm>

#include <utf8.h>

#include "host_sim/host/io/input_file.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kLargestToml = 1U << 20U;

void refuse_other_encodings(const std::string& text, const std::string& name) {
  const auto wrong = utf8::find_invalid(text.begin(), text.end());
  if (wrong == text.end()) return;
  throw UserError(fmt::format("{}:{}: not UTF-8; save the file as UTF-8", name,
                              1 + std::count(text.begin(), wrong, '\n')));
}

}  // namespace

std::string text_of_file(const std::filesystem::path& path) {
  return InputFile(path).beginning(kLargestToml + 1);
}

void check_toml_limits(const std::string& text, const std::string& name) {
  constexpr int kDeepest = 32;
  if (text.size() > kLargestToml)
    throw UserError(name + ": larger than 1 MiB, this is not a machine file");
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) throw UserError(name + ": brackets nested too deep");
  }
  refuse_other_encodings(text, name);
}

}  // namespace volcomp::host
