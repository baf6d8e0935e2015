#include "host_sim/host/tables/formats/isg_csv.hpp"

#include <fmt/format.h>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

struct Column {
  std::string text;
  bool argument = false;
  ErrorName name;
};

class IsgReader {
 public:
  IsgReader(std::istream& stream, const std::string& name, ForeignErrors& errors)
      : lines_(stream, name), errors_(errors) {}

  void read() {
    std::string line;
    bool anything = false;
    while (lines_.any(line)) {
      const std::string_view content = trimmed(without_comment(line));
      if (content.empty()) continue;
      anything = true;
      if (content == "#") {
        end_block();
      } else if (columns_.empty()) {
        read_header(words_of(content));
      } else {
        read_row(words_of(content));
      }
    }
    if (!anything) throw UserError(lines_.name() + ": the file is empty");
    end_block();
  }

 private:
  void end_block() {
    if (!columns_.empty() && rows_ == 0) lines_.fail("there is no record after the header");
    columns_.clear();
    rows_ = 0;
  }

  Column column_of(std::string_view word) const {
    Column column;
    column.text = std::string(word);
    column.argument =
        word.size() == 1 && std::string_view("XYZABC").find(word[0]) != std::string_view::npos;
    if (column.argument) column.name.axis = word[0];
    if (!column.argument && !read_error_name(word, column.name))
      lines_.fail(fmt::format(
          "unknown column {} (known: X Y Z A B C, errors as EXX, locations as C0Y)", quoted(word)));
    return column;
  }

  void read_header(const std::vector<std::string_view>& words) {
    for (const std::string_view word : words) {
      const Column column = column_of(word);
      for (const Column& other : columns_) {
        if (other.text == column.text)
          lines_.fail(fmt::format("column {} occurs twice", quoted(word)));
      }
      columns_.push_back(column);
    }
    check_header();
  }

  // One argument and errors of that axis, or locations without an argument.
  void check_header() {
    std::size_t arguments = 0;
    std::size_t locations = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].argument) {
        argument_ = i;
        ++arguments;
      }
      if (columns_[i].name.location) ++locations;
    }
    if (locations == columns_.size()) return;
    if (arguments == 0) lines_.fail("the header has no position X, Y, Z, A, B or C");
    if (arguments > 1)
      lines_.fail("errors that depend on several axes cannot be the table of one axis");
    if (columns_.size() == 1) lines_.fail("the header has no error");
    for (const Column& column : columns_) {
      if (column.name.location)
        lines_.fail(
            fmt::format("{} depends on no position: it needs a header of its own", column.text));
      if (column.name.axis != columns_[argument_].name.axis)
        lines_.fail(
            fmt::format("{} does not belong to axis {}", column.text, columns_[argument_].text));
      if (!column.argument && seen(column.name))
        lines_.fail(fmt::format("{} is there twice", column.text));
    }
  }

  [[nodiscard]] bool seen(const ErrorName& name) const {
    const auto found = errors_.axis.find(name.axis);
    return found != errors_.axis.end() && !found->second.at(name.channel).empty();
  }

  void read_row(const std::vector<std::string_view>& words) {
    if (words.size() != columns_.size())
      lines_.fail(fmt::format("{} numbers instead of {}", words.size(), columns_.size()));
    const bool locations = columns_.front().name.location;
    if (locations && rows_ > 0) lines_.fail("a location error has one value");
    for (std::size_t i = 0; i < words.size(); ++i) {
      const double value = lines_.number(words[i]);
      if (locations) add_location(errors_, columns_[i].text, value, lines_);
      if (locations || columns_[i].argument) continue;
      add_point(errors_, columns_[i].name, lines_.number(words[argument_]), value, lines_);
    }
    ++rows_;
  }

  CsvLines lines_;
  ForeignErrors& errors_;
  std::vector<Column> columns_;
  std::size_t argument_ = 0;
  std::size_t rows_ = 0;
};

}  // namespace

void read_isg_csv(std::istream& stream, const std::string& name, ForeignErrors& errors) {
  IsgReader(stream, name, errors).read();
}

}  // namespace volcomp::host
