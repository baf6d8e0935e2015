#include "host_sim/data/toml_text.hpp"

#include <fstream>

namespace volcomp::sim {

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw UserError(fmt::format("{}: cannot be opened", path.string()));
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void refuse_monsters(const std::string& text, const std::string& name) {
  constexpr std::size_t kLargest = 1U << 20U;
  constexpr int kDeepest = 32;
  if (text.size() > kLargest)
    throw UserError(name + ": larger than 1 MiB, this is not a machine file");
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) throw UserError(name + ": brackets nested too deep");
  }
}

}  // namespace volcomp::sim
