#pragma once
// Values of a measurement plan as people write them.

#include <string>

#include "comp/core/units.hpp"
#include "host_sim/host/io/toml_section.hpp"
#include "host_sim/host/measure/identify/problem.hpp"

namespace volcomp::host::identify {

inline constexpr double kMmPerUm = 1e-3;
inline constexpr double kRadPerUrad = 1e-6;
inline constexpr double kPpm = 1e-6;
inline constexpr double kRadPerDegree = kPi / 180.0;

// All throw UserError with file and line. What stands in tables and messages: no comma, nothing
// that does not print, no blank at either end, no # at the beginning, at most 80 bytes.
[[nodiscard]] std::string name_of(const TomlSection& s, const std::string& key);
// Larger than 0.
[[nodiscard]] double positive(const TomlSection& s, const std::string& key);
[[nodiscard]] Vec3 vector_of(const TomlSection& s, const std::string& key);
[[nodiscard]] Vec3 unit_of(const TomlSection& s, const std::string& key);
// A standard uncertainty, larger than 0, or "free".
[[nodiscard]] Prior prior_of(const TomlSection& s, const std::string& key, double unit);
[[nodiscard]] std::vector<std::string> words_of(const TomlSection& s, const std::string& key,
                                                const TomlValue& list);

}  // namespace volcomp::host::identify
