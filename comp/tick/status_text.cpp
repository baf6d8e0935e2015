#include "comp/tick/status_text.hpp"

#include "comp/core/counts_up.hpp"

namespace volcomp {
namespace {

constexpr std::array kNumbers{
#define STATUS_BIT(bit, enumerator, name, NAME, words) bit,
#include "comp/tick/codes.def"
};
static_assert(counts_up(kNumbers), "codes.def: the bits count up from 0");

constexpr std::array kNames{
#define STATUS_BIT(bit, enumerator, name, NAME, words) #name,
#include "comp/tick/codes.def"
};

constexpr std::array kWords{
#define STATUS_BIT(bit, enumerator, name, NAME, words) words,
#include "comp/tick/codes.def"
};
static_assert(kNames.size() == kStatusBits);

}  // namespace

const char* code(StatusBit bit) { return kNames[bit_of(bit)]; }

const char* words(StatusBit bit) { return kWords[bit_of(bit)]; }

}  // namespace volcomp
