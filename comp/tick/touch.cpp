#include "comp/tick/touch.hpp"

#include "comp/core/counts_up.hpp"

namespace volcomp {
namespace {

constexpr std::array kNumbers{
#define VERDICT(number, name, sentence) number,
#include "comp/tick/codes.def"
};
static_assert(counts_up(kNumbers), "codes.def: the numbers of verdicts count up from 0");

constexpr std::array kNames{
#define VERDICT(number, name, sentence) #name,
#include "comp/tick/codes.def"
};

constexpr std::array kSentences{
#define VERDICT(number, name, sentence) sentence,
#include "comp/tick/codes.def"
};
static_assert(kNames.size() == kTouchVerdicts);

}  // namespace

const char* code(TouchVerdict verdict) { return kNames[static_cast<std::size_t>(verdict)]; }

const char* sentence(TouchVerdict verdict) { return kSentences[static_cast<std::size_t>(verdict)]; }

}  // namespace volcomp
