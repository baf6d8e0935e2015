#include "host_sim/host/io/toml_text.hpp"

#include <string_view>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/utf8.hpp"

namespace volcomp::host {
namespace {

constexpr std::size_t kLargestToml = 1U << 20U;

// A newline is never a part of a longer sequence, so the lines are checked one by one.
void refuse_other_encodings(std::string_view text, const std::string& name) {
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!is_utf8(line))
      throw UserError(fmt::format("{}:{}: not UTF-8; save the file as UTF-8", name, number));
    text.remove_prefix(line.size());
    if (!text.empty()) text.remove_prefix(1);
  }
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
