#pragma once
// Suggests the known word that is nearest to a misspelt one.

#include <string>
#include <string_view>
#include <vector>

namespace volcomp::host {

// Returns the nearest word within two insertions, deletions or exchanges of a letter of `typed`
// (Levenshtein's distance); empty when there is none. Short words allow fewer: with two of three
// letters changed it is another word.
[[nodiscard]] std::string nearest_word(std::string_view typed,
                                       const std::vector<std::string>& words);

}  // namespace volcomp::host
