#pragma once
// A run of many draws computed in parts, by several processes or computers: each part is a file of
// its own, and all of them make the file of the whole run, to the last byte. A draw is the same
// wherever it is computed, since its random numbers depend on its number alone.

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/io/hashed_input.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {

// Which part: draws number − 1, number − 1 + of, … counted from 0.
struct Shard {
  std::size_t number = 1;
  std::size_t of = 1;

  [[nodiscard]] std::vector<std::size_t> draws_of(std::size_t all) const;
};

inline constexpr std::size_t kMostShards = 10'000;

// "2/8". Throws UserError.
[[nodiscard]] Shard parse_shard(const std::string& text);

// NOLINTNEXTLINE(bugprone-exception-escape): nothing in nlohmann::json throws when moved
struct PartialRun {
  std::string experiment;  // "xyfz"
  std::size_t draws = 0;   // of the whole run
  nlohmann::json run;      // options, seeds, hashes of inputs: alike in all parts
  nlohmann::json figures;  // what does not depend on the draws: alike in all parts
  std::map<std::size_t, nlohmann::json> draw;  // those of the part, or all
};

// What each input is and its SHA-256: the folder it lies in may differ from part to part.
[[nodiscard]] nlohmann::json hashes_of(const std::vector<HashedInput>& inputs);

// Numbers are written so that they are read back to the last bit.
[[nodiscard]] nlohmann::json partial_json(const PartialRun& part, const Shard& shard);

// Throws UserError naming the file: none of these, one of another run or version, more than 64 MiB,
// a draw that is there twice or not at all.
[[nodiscard]] PartialRun collect_parts(const std::vector<std::filesystem::path>& paths);

// A text of a part that is shown on a terminal. Throws UserError naming `what`: no text, or with
// control characters in it.
[[nodiscard]] std::string text_of_part(const nlohmann::json& value, const char* what);

// `count` finite numbers of a result. Throws UserError naming `what`.
template <std::size_t count>
[[nodiscard]] std::array<double, count> numbers_of(const nlohmann::json& values, const char* what) {
  std::array<double, count> out{};
  bool good = values.is_array() && values.size() == count;
  for (std::size_t i = 0; good && i < count; ++i) {
    good = values[i].is_number();
    if (good) out[i] = values[i].get<double>();
    good = good && std::isfinite(out[i]) && std::abs(out[i]) < 1e9;
  }
  if (!good) throw UserError(std::string("a part of the run: \"") + what + "\" is unusable");
  return out;
}

}  // namespace volcomp::host
