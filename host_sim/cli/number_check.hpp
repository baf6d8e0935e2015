#pragma once
// Checks of options that take numbers. Those of CLI11 compare with < and >, so "nan" passes them
// all, and its whole numbers read "-1" as the largest.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace volcomp::cli {

// From `least` to `most`, both included.
inline CLI::Validator number_between(double least, double most) {
  return {[least, most](const std::string& text) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                              value >= least && value <= most;
            return good ? std::string()
                        : fmt::format("{} is not a number from {:g} to {:g}", text, least, most);
          },
          fmt::format("FLOAT in [{:g} - {:g}]", least, most)};
}

// 0 … 2^64 - 1, in decimal digits.
inline CLI::Validator seed_number() {
  return {[](const std::string& text) {
            std::uint64_t seed = 0;
            const char* const end = text.data() + text.size();
            const auto [stopped, error] = std::from_chars(text.data(), end, seed);
            const bool good = error == std::errc() && stopped == end;
            return good ? std::string()
                        : fmt::format("{} is not a whole number from 0 to 2^64 - 1", text);
          },
          ""};
}

}  // namespace volcomp::cli
