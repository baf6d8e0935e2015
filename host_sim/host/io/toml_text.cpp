#include "host_sim/host/io/toml_text.hpp"

#include <algorithm>

// toml++ 3.3 asserts that a name follows the bracket of a table, where a comment may follow ("[#"),
// and refuses that with its next check. An assertion would end the program before.
#undef NDEBUG
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>
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

// The parser recurses once a bracket.
void refuse_unlikely_text(const std::string& text, const std::string& name) {
  constexpr int kDeepest = 32;
  if (text.size() > kLargestToml)
    throw UserError(name + ": larger than 1 MiB, this is not a machine file");
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) throw UserError(name + ": brackets nested too deep");
  }
}

// As deep as refuse_unlikely_text lets brackets be.
// NOLINTBEGIN(misc-no-recursion)
TomlValue value_of(const toml::node& node);

TomlValue::Array values_of(const toml::array& array) {
  TomlValue::Array values;
  for (const toml::node& entry : array)
    values.push_back(value_of(entry));
  return values;
}

TomlValue::Table values_of(const toml::table& table) {
  TomlValue::Table values;
  for (const auto& [key, entry] : table)
    values.emplace(key.str(), value_of(entry));
  return values;
}

TomlValue value_of(const toml::node& node) {
  const long line = node.source().begin.line;
  if (const auto* const array = node.as_array()) return {values_of(*array), line};
  if (const auto* const table = node.as_table()) return {values_of(*table), line};
  if (const auto* const truth = node.as_boolean()) return {truth->get(), line};
  if (const auto* const integer = node.as_integer()) return {integer->get(), line};
  if (const auto* const number = node.as_floating_point()) return {number->get(), line};
  if (const auto* const text = node.as_string()) return {text->get(), line};
  return {std::monostate(), line};
}
// NOLINTEND(misc-no-recursion)

}  // namespace

std::string text_of_file(const std::filesystem::path& path) {
  return InputFile(path).beginning(kLargestToml + 1);
}

TomlValue parse_toml(const std::string& text, const std::string& name) {
  refuse_unlikely_text(text, name);
  refuse_other_encodings(text, name);
  try {
    return value_of(toml::parse(text, name));
  } catch (const toml::parse_error& e) {
    throw UserError(fmt::format("{}:{}: not valid TOML", name, e.source().begin.line));
  }
}

}  // namespace volcomp::host
