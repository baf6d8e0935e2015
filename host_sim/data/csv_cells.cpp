#include "host_sim/data/csv_cells.hpp"

#include <charconv>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
    text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string quoted(std::string_view cell) {
  std::string text;
  for (const char c : cell.substr(0, 40))
    text += (c >= ' ' && c <= '~') ? c : '?';
  return '"' + text + '"';
}

bool CsvLines::next(std::string& line) {
  while (std::getline(stream_, line)) {
    ++line_;
    if (line_ == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') return true;
  }
  return false;
}

void CsvLines::fail(const std::string& text) const {
  throw UserError(fmt::format("{}:{}: {}", name_, line_, text));
}

double CsvLines::number(std::string_view cell, const std::string& what) const {
  double value = 0.0;
  const char* begin = cell.data();
  const char* end = begin + cell.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range)
    fail(fmt::format("{}{} is out of range", what, quoted(cell)));
  if (error != std::errc{} || stop != end)
    fail(fmt::format("{}{} is not a number", what, quoted(cell)));
  return value;
}

}  // namespace volcomp::sim
