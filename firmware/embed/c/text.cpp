// What the numbers of volcomp.h mean, and that they are those of the C++ code.

#include "comp/tick/status_text.hpp"
#include "firmware/embed/c/compensator.hpp"

namespace {

using volcomp::Reason;
using volcomp::StatusBit;
using volcomp::TouchVerdict;

// A line that volcomp.h tells differently, or not at all, is named by the compiler.
#define LOADING(number, name, NAME, sentence) static_assert(VOLCOMP_##NAME == (number));
#include "comp/core/reasons.def"
#define STATUS_BIT(bit, enumerator, name, NAME, words) static_assert(VOLCOMP_##NAME == 1 << (bit));
#define POINT_VERDICT(number, name, NAME, sentence) static_assert(VOLCOMP_##NAME == (number));
#include "comp/tick/codes.def"

constexpr const char* kUnknown = "unknown";

struct Text {
  const char* code;
  const char* sentence;
};

// Texts of the reasons that only this interface has; else empty.
Text own_text(int reason) {
  switch (reason) {
    case VOLCOMP_NULL_POINTER:
      return {"null_pointer", "An argument that is needed is a null pointer."};
    case VOLCOMP_MEMORY_TOO_SMALL:
      return {"memory_too_small",
              "The memory for the compensator is too small; it needs VOLCOMP_BYTES."};
    case VOLCOMP_MEMORY_MISALIGNED:
      return {"memory_misaligned",
              "The memory for the compensator is not aligned; declare it as a volcomp_memory."};
    default:
      return {nullptr, nullptr};
  }
}

// Reasons are one byte.
Reason reason_of(int reason) {
  return static_cast<Reason>(reason >= 0 && reason <= UINT8_MAX ? reason : UINT8_MAX);
}

constexpr unsigned kAllBits = (1U << static_cast<unsigned>(VOLCOMP_STATUS_BITS)) - 1U;

StatusBit lowest(unsigned status) { return static_cast<StatusBit>(status & (0U - status)); }

bool is_verdict(int verdict) { return verdict >= 0 && verdict < volcomp::kTouchVerdicts; }

}  // namespace

const char* volcomp_code(int reason) {
  const Text own = own_text(reason);
  return own.code != nullptr ? own.code : code(reason_of(reason));
}

const char* volcomp_sentence(int reason) {
  const Text own = own_text(reason);
  return own.sentence != nullptr ? own.sentence : sentence(reason_of(reason));
}

const char* volcomp_status_code(unsigned status) {
  return (status & kAllBits) == 0 ? kUnknown : code(lowest(status & kAllBits));
}

const char* volcomp_status_words(unsigned status) {
  return (status & kAllBits) == 0 ? kUnknown : words(lowest(status & kAllBits));
}

const char* volcomp_verdict_code(int verdict) {
  return is_verdict(verdict) ? code(static_cast<TouchVerdict>(verdict)) : kUnknown;
}

const char* volcomp_verdict_sentence(int verdict) {
  return is_verdict(verdict) ? sentence(static_cast<TouchVerdict>(verdict)) : kUnknown;
}
