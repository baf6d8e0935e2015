#pragma once
// Lines of a CSV file as cells, and cells as numbers: what the readers of measured data share.

#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace volcomp::host {

// Without blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

[[nodiscard]] std::vector<std::string_view> cells_of(std::string_view line);

// Separated by blanks.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);

// What is before "//".
[[nodiscard]] std::string_view without_comment(std::string_view line);

// Cells may hold anything; only their printable beginning is quoted back.
[[nodiscard]] std::string quoted(std::string_view cell);

// The lines of a file. Throws UserError for a line no table has (64 KiB), for UTF-16 and when the
// file cannot be read to its end.
class CsvLines {
 public:
  CsvLines(std::istream& stream, std::string name) : stream_(stream), name_(std::move(name)) {}

  // The next line that has content: not empty, not a comment (#). Fails if it is not UTF-8.
  bool next(std::string& line);

  // The next line.
  bool any(std::string& line);

  [[nodiscard]] const std::string& name() const { return name_; }
  // The line read last, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }

  // Throws UserError("NAME:LINE: text").
  [[noreturn]] void fail(const std::string& text) const;

  // The cells of a header. Fails with the name of the separator where it is not the comma.
  [[nodiscard]] std::vector<std::string_view> header_cells(std::string_view line) const;

  // A cell as a number, "nan" and "inf" among them; fails with `what` before the cell.
  [[nodiscard]] double number(std::string_view cell, const std::string& what = {}) const;

 private:
  bool read_line(std::string& line);

  std::istream& stream_;
  std::string name_;
  std::size_t line_ = 0;
};

}  // namespace volcomp::host
