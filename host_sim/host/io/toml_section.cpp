#include "host_sim/host/io/toml_section.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/io/nearest_word.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

TomlSection::TomlSection(const TomlValue& value, std::string file, std::string name)
    : value_(&value), file_(std::move(file)), name_(std::move(name)) {
  if (!value.is_table()) fail(value, fmt::format("'{}' must be a table", name_));
}

void TomlSection::fail(const TomlValue& at, const std::string& text) const {
  throw UserError(fmt::format("{}:{}: {}", file_, at.line(), text));
}

void TomlSection::complain(const std::string& key, const std::string& text) const {
  const TomlValue* const at = find(key);
  fail(at == nullptr ? *value_ : *at, text);
}

const TomlValue* TomlSection::find(const std::string& key) const {
  const TomlValue::Table& table = value_->table();
  const auto it = table.find(key);
  return it == table.end() ? nullptr : &it->second;
}

const TomlValue& TomlSection::need(const std::string& key) const {
  const TomlValue* value = find(key);
  if (value == nullptr)
    fail(*value_, fmt::format("missing mandatory field '{}' in {} [{}]", key, name_,
                              code(Reason::missing_field)));
  return *value;
}

double TomlSection::finite(const TomlValue& value, const std::string& key) const {
  const double x = value.is_number() ? value.number() : std::nan("");
  if (!std::isfinite(x)) fail(value, fmt::format("'{}' must be a finite number", key));
  return x;
}

double TomlSection::number(const std::string& key) const { return finite(need(key), key); }

double TomlSection::number_or(const std::string& key, double fallback) const {
  return has(key) ? number(key) : fallback;
}

long TomlSection::integer(const std::string& key, long lo, long hi) const {
  const TomlValue& v = need(key);
  if (!v.is_integer() || v.integer() < lo || v.integer() > hi) {
    fail(v, fmt::format("'{}' must be a whole number from {} to {}", key, lo, hi));
  }
  return v.integer();
}

long TomlSection::integer_or(const std::string& key, long fallback, long lo, long hi) const {
  return has(key) ? integer(key, lo, hi) : fallback;
}

bool TomlSection::truth_or(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  const TomlValue& v = need(key);
  if (!v.is_truth()) fail(v, fmt::format("'{}' must be true or false", key));
  return v.truth();
}

std::string TomlSection::text(const std::string& key) const {
  const TomlValue& v = need(key);
  if (!v.is_text() || v.text().empty()) fail(v, fmt::format("'{}' must be a text", key));
  return v.text();
}

std::size_t TomlSection::choice(const std::string& key,
                                const std::vector<std::string>& words) const {
  const std::string word = text(key);
  const auto it = std::find(words.begin(), words.end(), word);
  if (it == words.end()) {
    complain(key,
             fmt::format("'{}' is \"{}\", must be one of: {}", key, word, fmt::join(words, ", ")));
  }
  return static_cast<std::size_t>(it - words.begin());
}

std::vector<double> TomlSection::numbers(const std::string& key, std::size_t count) const {
  const TomlValue& v = need(key);
  if (!v.is_array() || v.array().size() != count) {
    fail(v, fmt::format("'{}' must be a list of {} numbers", key, count));
  }
  std::vector<double> out;
  for (const TomlValue& entry : v.array())
    out.push_back(finite(entry, key));
  return out;
}

TomlSection TomlSection::table(const std::string& key) const {
  return {need(key), file_, "[" + key + "]"};
}

std::vector<TomlSection> TomlSection::tables(const std::string& key) const {
  const TomlValue& list = need(key);
  if (!list.is_array() || list.array().empty())
    fail(list, fmt::format("'{}' must be a list of tables", key));
  std::vector<TomlSection> sections;
  for (const TomlValue& v : list.array())
    sections.emplace_back(v, file_, "[[" + key + "]]");
  return sections;
}

void TomlSection::allow_only(const std::vector<std::string>& keys) const {
  for (const auto& [key, value] : value_->table()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string near = nearest_word(key, keys);
    fail(value, fmt::format("unknown field '{}' in {}{} (known: {})", key, name_,
                            near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                            fmt::join(keys, ", ")));
  }
}

void TomlSection::check(const Status& status, const std::string& key) const {
  if (!status.ok()) complain(key, describe(status));
}

}  // namespace volcomp::host
