#include "host_sim/host/io/nearest_word.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace volcomp::host {
namespace {

constexpr std::size_t kFarthest = 2;
constexpr std::size_t kLongest = 64;  // no field is longer

// Row by row of the table of distances between the beginnings of both.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t exchanged = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({exchanged, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_word(std::string_view typed, const std::vector<std::string>& words) {
  if (typed.size() > kLongest) return {};
  std::string nearest;
  std::size_t least = std::min(kFarthest, typed.size() / 2) + 1;
  for (const std::string& word : words) {
    const std::size_t d = distance(typed, word);
    if (d >= least) continue;
    least = d;
    nearest = word;
  }
  return nearest;
}

}  // namespace volcomp::host
