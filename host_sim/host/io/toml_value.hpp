#pragma once
// What a TOML file says, as a tree of values that know their line. The library that parses the text
// stays within toml_text.cpp.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace volcomp::host {

class TomlValue {
 public:
  using Array = std::vector<TomlValue>;
  using Table = std::map<std::string, TomlValue>;
  // T: one of the contents below.
  template <class T>
  TomlValue(T content, long line)
      : content_(std::in_place_type<T>, std::move(content)), line_(line) {}

  [[nodiscard]] bool is_truth() const { return is<bool>(); }
  [[nodiscard]] bool is_integer() const { return is<std::int64_t>(); }
  [[nodiscard]] bool is_number() const { return is_integer() || is<double>(); }
  [[nodiscard]] bool is_text() const { return is<std::string>(); }
  [[nodiscard]] bool is_array() const { return is<Array>(); }
  [[nodiscard]] bool is_table() const { return is<Table>(); }

  // Of a value that is one; otherwise std::bad_variant_access.
  [[nodiscard]] bool truth() const { return std::get<bool>(content_); }
  [[nodiscard]] std::int64_t integer() const { return std::get<std::int64_t>(content_); }
  [[nodiscard]] double number() const {  // an integer, too
    return is_integer() ? static_cast<double>(integer()) : std::get<double>(content_);
  }
  [[nodiscard]] const std::string& text() const { return std::get<std::string>(content_); }
  [[nodiscard]] const Array& array() const { return std::get<Array>(content_); }
  [[nodiscard]] const Table& table() const { return std::get<Table>(content_); }

  // The first line is 1. That of a table is where its header or its brace stands.
  [[nodiscard]] long line() const { return line_; }

 private:
  template <class T>
  [[nodiscard]] bool is() const {
    return std::holds_alternative<T>(content_);
  }

  // std::monostate: a date or a time, which no file of ours holds.
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> content_;
  long line_;
};

}  // namespace volcomp::host
