#include "comp/core/status.hpp"

#include <array>
#include <cstddef>

// In a file of its own: an image that uses nothing else links no other text (reason_text.cpp).

namespace volcomp {
namespace {

constexpr std::array kLoading{
#define LOADING(number, name, NAME, sentence) Reason::name,
#include "comp/core/reasons.def"
};

constexpr std::array kLoadingSentences{
#define LOADING(number, name, NAME, sentence) sentence,
#include "comp/core/reasons.def"
};

}  // namespace

Where::Where() = default;

Status::Status() = default;

Status::Status(Reason why, const Where& place) : reason(why), where(place) {}

Status refuse(Reason reason) { return {reason, {}}; }

Status refuse(Reason reason, const Where& where) { return {reason, where}; }

Status refuse_value(Reason reason, const char* field, double value) {
  Where where;
  where.field = field;
  where.value = value;
  where.has_value = true;
  return refuse(reason, where);
}

const char* loading_sentence(Reason reason) {
  for (std::size_t i = 0; i < kLoading.size(); ++i) {
    if (kLoading[i] == reason) return kLoadingSentences[i];
  }
  return nullptr;
}

}  // namespace volcomp
