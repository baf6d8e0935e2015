#pragma once
// Suggests the known word that is nearest to a misspelt one.

#include <string>
#include <string_view>
#include <vector>

namespace volcomp::host {

// The word that two insertions, deletions or exchanges of a letter at most make of `typed`
// (Levenshtein's distance), the nearest first; empty when there is none. Of short words fewer: two
// of three letters are another word.
[[nodiscard]] std::string nearest_word(std::string_view typed,
                                       const std::vector<std::string>& words);

}  // namespace volcomp::host
