// What the numbers of volcomp.h mean, and that they are those of the C++ code.

#include "comp/tick/status_text.hpp"
#include "firmware/embed/c/compensator.hpp"

namespace {

using volcomp::Reason;
using volcomp::StatusBit;
using volcomp::TouchVerdict;

constexpr bool same(Reason reason, volcomp_reason number) {
  return static_cast<int>(reason) == static_cast<int>(number);
}
static_assert(same(Reason::ok, VOLCOMP_OK));
static_assert(same(Reason::not_finite, VOLCOMP_NOT_FINITE));
static_assert(same(Reason::too_few_knots, VOLCOMP_TOO_FEW_KNOTS));
static_assert(same(Reason::too_many_knots, VOLCOMP_TOO_MANY_KNOTS));
static_assert(same(Reason::pitch_not_positive, VOLCOMP_PITCH_NOT_POSITIVE));
static_assert(same(Reason::travel_too_long, VOLCOMP_TRAVEL_TOO_LONG));
static_assert(same(Reason::not_periodic, VOLCOMP_NOT_PERIODIC));
static_assert(same(Reason::bad_magic, VOLCOMP_BAD_MAGIC));
static_assert(same(Reason::version_unknown, VOLCOMP_VERSION_UNKNOWN));
static_assert(same(Reason::image_truncated, VOLCOMP_IMAGE_TRUNCATED));
static_assert(same(Reason::crc_mismatch, VOLCOMP_CRC_MISMATCH));
static_assert(same(Reason::machine_mismatch, VOLCOMP_MACHINE_MISMATCH));
static_assert(same(Reason::axes_mismatch, VOLCOMP_AXES_MISMATCH));
static_assert(same(Reason::bound_exceeded, VOLCOMP_BOUND_EXCEEDED));
static_assert(same(Reason::contraction_exceeded, VOLCOMP_CONTRACTION_EXCEEDED));
static_assert(same(Reason::parent_not_lower, VOLCOMP_PARENT_NOT_LOWER));
static_assert(same(Reason::not_one_root, VOLCOMP_NOT_ONE_ROOT));
static_assert(same(Reason::bad_body, VOLCOMP_BAD_BODY));
static_assert(same(Reason::too_many_bodies, VOLCOMP_TOO_MANY_BODIES));
static_assert(same(Reason::too_many_axes, VOLCOMP_TOO_MANY_AXES));
static_assert(same(Reason::bad_joint, VOLCOMP_BAD_JOINT));
static_assert(same(Reason::not_a_rotation, VOLCOMP_NOT_A_ROTATION));
static_assert(same(Reason::bad_axis_index, VOLCOMP_BAD_AXIS_INDEX));
static_assert(same(Reason::no_authority, VOLCOMP_NO_AUTHORITY));
static_assert(same(Reason::bad_setting, VOLCOMP_BAD_SETTING));
static_assert(same(Reason::not_staged, VOLCOMP_NOT_STAGED));
static_assert(same(Reason::hand_over_pending, VOLCOMP_HAND_OVER_PENDING));
static_assert(same(Reason::bad_thermal, VOLCOMP_BAD_THERMAL));
static_assert(same(Reason::expired, VOLCOMP_EXPIRED));
static_assert(same(Reason::cannot_orient, VOLCOMP_CANNOT_ORIENT));

constexpr bool same(StatusBit bit, volcomp_status_bit number) {
  return static_cast<int>(bit) == static_cast<int>(number);
}
static_assert(same(StatusBit::kValid, VOLCOMP_VALID));
static_assert(same(StatusBit::kNotHomed, VOLCOMP_NOT_HOMED));
static_assert(same(StatusBit::kStale, VOLCOMP_STALE));
static_assert(same(StatusBit::kDropped, VOLCOMP_DROPPED));
static_assert(same(StatusBit::kImplausible, VOLCOMP_IMPLAUSIBLE));
static_assert(same(StatusBit::kOutOfRange, VOLCOMP_OUT_OF_RANGE));
static_assert(same(StatusBit::kFarOutOfRange, VOLCOMP_FAR_OUT_OF_RANGE));
static_assert(same(StatusBit::kClamped, VOLCOMP_CLAMPED));
static_assert(same(StatusBit::kRateLimited, VOLCOMP_RATE_LIMITED));
static_assert(same(StatusBit::kDirectionUnknown, VOLCOMP_DIRECTION_UNKNOWN));
static_assert(same(StatusBit::kRamping, VOLCOMP_RAMPING));
static_assert(same(StatusBit::kNoAuthority, VOLCOMP_NO_AUTHORITY_HERE));
static_assert(same(StatusBit::kNoTables, VOLCOMP_NO_TABLES));
static_assert(same(StatusBit::kTableDamaged, VOLCOMP_TABLE_DAMAGED));

constexpr bool same(TouchVerdict verdict, volcomp_verdict number) {
  return static_cast<int>(verdict) == static_cast<int>(number);
}
static_assert(same(TouchVerdict::point, VOLCOMP_POINT));
static_assert(same(TouchVerdict::centre, VOLCOMP_CENTRE));
static_assert(same(TouchVerdict::uncertified, VOLCOMP_UNCERTIFIED));
static_assert(same(TouchVerdict::uncorrected, VOLCOMP_UNCORRECTED));
static_assert(same(TouchVerdict::retracting, VOLCOMP_RETRACTING));
static_assert(same(TouchVerdict::no_machine, VOLCOMP_NO_MACHINE));

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
