#include "host_sim/host/io/csv_cells.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <utf8.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

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

std::vector<std::string_view> words_of(std::string_view line) {
  static constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find("//")); }

std::string quoted(std::string_view cell) {
  std::string text;
  for (const char c : cell.substr(0, 40))
    text += (c >= ' ' && c <= '~') ? c : '?';
  return '"' + text + '"';
}

bool CsvLines::next(std::string& line) {
  while (any(line)) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    if (!utf8::is_valid(content.begin(), content.end()))
      fail("the line is not UTF-8; save the file as UTF-8 or ASCII");
    return true;
  }
  return false;
}

bool CsvLines::any(std::string& line) {
  if (!read_line(line)) return false;
  if (line_ > 1) return true;
  if (line.rfind("\xFF\xFE", 0) == 0 || line.rfind("\xFE\xFF", 0) == 0)
    fail("the file is UTF-16; it must be saved as UTF-8 or ASCII");
  if (line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
  return true;
}

// As std::getline, but a device or a binary file does not fill the memory.
bool CsvLines::read_line(std::string& line) {
  constexpr std::size_t kLongest = std::size_t{1} << 16U;
  using Traits = std::istream::traits_type;
  line.clear();
  bool anything = false;
  for (;;) {
    const Traits::int_type c = stream_.get();
    if (Traits::eq_int_type(c, Traits::eof())) {
      if (stream_.bad()) throw UserError(name_ + ": cannot be read to its end");
      return anything;
    }
    if (!anything) ++line_;
    anything = true;
    if (Traits::to_char_type(c) == '\n') return true;
    if (line.size() == kLongest) fail("the line is longer than 64 KiB");
    line += Traits::to_char_type(c);
  }
}

void CsvLines::fail(const std::string& text) const {
  throw UserError(fmt::format("{}:{}: {}", name_, line_, text));
}

// As a spreadsheet saves it where the comma is the decimal point, and what is copied from one.
std::vector<std::string_view> CsvLines::header_cells(std::string_view line) const {
  const auto count = [&](char c) { return std::count(line.begin(), line.end(), c); };
  const auto refuse = [&](const char* separator) {
    fail(fmt::format("the header is separated by {}; columns must be separated by commas",
                     separator));
  };
  if (count(';') > count(',')) refuse("semicolons");
  if (count('\t') > count(',')) refuse("tabs");
  return cells_of(line);
}

double CsvLines::number(std::string_view cell, const std::string& what) const {
  double value = 0.0;
  const char* begin = cell.data();
  const char* end = begin + cell.size();
  // One sign, as every other reader of numbers has it: "+-1" is none.
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range)
    fail(fmt::format("{}{} is out of range", what, quoted(cell)));
  if (error != std::errc{} || stop != end)
    fail(fmt::format("{}{} is not a number", what, quoted(cell)));
  return value;
}

}  // namespace volcomp::host
