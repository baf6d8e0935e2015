#include "comp/tick/status_text.hpp"

namespace volcomp {
namespace {

struct Entry {
  const char* code;
  const char* words;
};

// By bit.
constexpr std::array<Entry, kStatusBits> kEntries{{
    {"valid", "corrected"},
    {"not_homed", "not referenced or not enabled, no correction"},
    {"stale", "no position in time, correction held"},
    {"dropped", "no position for too long, correction ramped to zero"},
    {"implausible", "position jumped, correction held"},
    {"out_of_range", "beyond its table, correction of the end"},
    {"far_out_of_range", "more than half a pitch beyond its table"},
    {"clamped", "correction at its limit"},
    {"rate_limited", "correction held back by its slew limit"},
    {"direction_unknown", "has not moved yet, mean of both directions"},
    {"ramping", "a change is being ramped in"},
    {"no_authority", "the correcting axes cannot act here"},
    {"no_tables", "no tables"},
    {"table_damaged", "tables damaged in memory, correction ramped to zero"},
}};

}  // namespace

const char* code(StatusBit bit) { return kEntries[bit_of(bit)].code; }

const char* words(StatusBit bit) { return kEntries[bit_of(bit)].words; }

}  // namespace volcomp
