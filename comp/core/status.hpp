#pragma once
// Why a call was refused, and where: every rejected input has its own reason, sentence and test.
//
// Nothing in comp throws. A function that can fail returns a Status that cannot be ignored and
// leaves everything it was given to write untouched.

#include <cstdint>

namespace volcomp {

// With their sentences in reasons.def.
enum class Reason : std::uint8_t {
#define REASON(number, name, sentence) name = (number),
#include "comp/core/reasons.def"
};

// What a Status points at. A negative number or an empty name means "does not apply".
struct Where {
  Where();

  char axis = '\0';                 // axis letter
  const char* direction = nullptr;  // "up" or "down"
  const char* field = nullptr;      // name of the offending field or setting
  int run = -1;
  int target = -1;   // 0-based
  int channel = -1;  // 0…5 = EX EY EZ EA EB EC
  int index = -1;
  int body = -1;           // 1-based, as in a lower-body array
  int count = -1;          // how many there are (knots, bodies, axes)
  double value = 0.0;      // the offending value, where has_value
  double deviation = 0.0;  // signed distance from what was expected, where has_deviation
  bool has_value = false;
  bool has_deviation = false;
};

// Its constructors and refuse() are functions of their own, for the sake of flash: a place is
// larger than the calls that fill it in, and boards have many.
struct [[nodiscard]] Status {
  Status();  // ok
  Status(Reason why, const Where& place);

  Reason reason = Reason::ok;
  Where where;

  [[nodiscard]] constexpr bool ok() const { return reason == Reason::ok; }
};

Status refuse(Reason reason);
Status refuse(Reason reason, const Where& where);

// With the offending value of a field.
Status refuse_value(Reason reason, const char* field, double value);

// Stable machine-readable name, for instance "crc_mismatch".
[[nodiscard]] const char* code(Reason reason);

// One plain sentence for a person, without the place.
[[nodiscard]] const char* sentence(Reason reason);

// The same for what an image or a setting can be refused for; nullptr for other reasons.
[[nodiscard]] const char* loading_sentence(Reason reason);

}  // namespace volcomp
