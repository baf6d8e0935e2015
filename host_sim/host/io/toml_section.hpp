#pragma once
// One table of a TOML file that remembers where it is, so that every complaint names file and line.

#include <array>
#include <string>
#include <vector>

#include "comp/core/status.hpp"
#include "host_sim/host/io/toml_value.hpp"

namespace volcomp::host {

class TomlSection {
 public:
  // `value` must outlive the section and be a table.
  TomlSection(const TomlValue& value, std::string file, std::string name);

  [[nodiscard]] bool has(const std::string& key) const { return find(key) != nullptr; }
  [[nodiscard]] const TomlValue& need(const std::string& key) const;  // missing_field

  [[nodiscard]] double number(const std::string& key) const;  // finite
  [[nodiscard]] double number_or(const std::string& key, double fallback) const;
  [[nodiscard]] long integer(const std::string& key, long lo, long hi) const;
  [[nodiscard]] long integer_or(const std::string& key, long fallback, long lo, long hi) const;
  [[nodiscard]] bool truth_or(const std::string& key, bool fallback) const;  // true or false
  [[nodiscard]] std::string text(const std::string& key) const;
  // One of the given words, by position.
  [[nodiscard]] std::size_t choice(const std::string& key,
                                   const std::vector<std::string>& words) const;
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) const;

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(const std::string& key) const {
    const std::vector<double> list = numbers(key, N);
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i)
      out[i] = list[i];
    return out;
  }

  [[nodiscard]] TomlSection table(const std::string& key) const;
  [[nodiscard]] std::vector<TomlSection> tables(const std::string& key) const;  // at least one

  // A misspelt field is an error, not a default.
  void allow_only(const std::vector<std::string>& keys) const;
  // A refusal of the library, at the line of a field.
  void check(const Status& status, const std::string& key) const;
  [[noreturn]] void complain(const std::string& key, const std::string& text) const;

 private:
  [[nodiscard]] const TomlValue* find(const std::string& key) const;
  [[nodiscard]] double finite(const TomlValue& value, const std::string& key) const;
  [[noreturn]] void fail(const TomlValue& at, const std::string& text) const;

  const TomlValue* value_;
  std::string file_;
  std::string name_;
};

}  // namespace volcomp::host
