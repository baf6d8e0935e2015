#include "host_sim/host/measure/identify/plan_values.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace volcomp::host::identify {

std::string name_of(const TomlSection& s, const std::string& key) {
  constexpr std::size_t kLongest = 80;
  std::string name = s.text(key);
  const bool prints = std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f || c == ',';
  });
  if (!prints || name.empty() || name.size() > kLongest || name.front() == ' ' ||
      name.back() == ' ' || name.front() == '#')
    s.complain(key,
               fmt::format("'{}' must have 1 to {} bytes without comma and control characters, "
                           "without a blank at either end and no # in front",
                           key, kLongest));
  return name;
}

double positive(const TomlSection& s, const std::string& key) {
  const double value = s.number(key);
  if (!(value > 0.0)) s.complain(key, fmt::format("'{}' must be larger than 0", key));
  return value;
}

Vec3 vector_of(const TomlSection& s, const std::string& key) {
  const auto v = s.numbers<3>(key);
  return {v[0], v[1], v[2]};
}

Vec3 unit_of(const TomlSection& s, const std::string& key) {
  const Vec3 v = vector_of(s, key);
  if (!(v.norm() > 0.0)) s.complain(key, fmt::format("'{}' must not be 0", key));
  return v.normalized();
}

Prior prior_of(const TomlSection& s, const std::string& key, double unit) {
  const TomlValue& v = s.need(key);
  if (v.is_text() && v.text() == "free") return kFree;
  return unit * positive(s, key);
}

std::vector<std::string> words_of(const TomlSection& s, const std::string& key,
                                  const TomlValue& list) {
  std::vector<std::string> out;
  if (!list.is_array()) s.complain(key, fmt::format("'{}' must be a list of names", key));
  for (const TomlValue& v : list.array()) {
    if (!v.is_text()) s.complain(key, fmt::format("'{}' must be a list of names", key));
    out.push_back(v.text());
  }
  return out;
}

}  // namespace volcomp::host::identify
