#include <array>
#include <cstddef>

#include "comp/core/counts_up.hpp"
#include "comp/core/status.hpp"

namespace volcomp {
namespace {

constexpr std::array kNumbers{
#define REASON(number, name, sentence) number,
#include "comp/core/reasons.def"
};
static_assert(counts_up(kNumbers), "reasons.def: the numbers count up from 0");

constexpr std::array kNames{
#define REASON(number, name, sentence) #name,
#include "comp/core/reasons.def"
};

constexpr std::array kSentences{
#define REASON(number, name, sentence) sentence,
#include "comp/core/reasons.def"
};

}  // namespace

const char* code(Reason reason) {
  const auto number = static_cast<std::size_t>(reason);
  return number < kNames.size() ? kNames[number] : "unknown";
}

const char* sentence(Reason reason) {
  const auto number = static_cast<std::size_t>(reason);
  return number < kSentences.size() ? kSentences[number] : "Unknown reason.";
}

}  // namespace volcomp
