#include "firmware/canopen/object_dictionary.hpp"

#include <algorithm>
#include <cstring>

#include "comp/core/bytes.hpp"

namespace volcomp::canopen {
namespace {

std::size_t stride(const Entry& entry) {
  return entry.type() == DataType::visible_string ? entry.extra : entry.size();
}

}  // namespace

const char* sentence(AbortCode code) {
  switch (code) {
    case AbortCode::none:
      return "The transfer succeeded.";
#define ABORT_CODE(number, name, sentence) \
  case AbortCode::name:                    \
    return sentence;
#include "firmware/canopen/codes.def"
  }
  return "The device gave an abort code of its own.";
}

std::size_t Entry::size() const { return size_of(type()); }

ObjectDictionary::Found ObjectDictionary::find(ObjectId object) const {
  const Entry* const first =
      std::lower_bound(rows_.begin(), rows_.end(), object.index,
                       [](const Entry& row, std::uint16_t index) { return row.index < index; });
  Found found;
  found.why = AbortCode::no_object;
  for (const Entry* row = first; row != rows_.end() && row->index == object.index; ++row) {
    found.highest_sub = row->last_sub;
    found.why = found.entry == nullptr ? AbortCode::no_subindex : AbortCode::none;
    if (object.sub < row->first_sub || object.sub > row->last_sub) continue;
    found.entry = row;
    found.why = AbortCode::none;
    if (row->type() == DataType::domain) continue;
    found.value = values_ + row->offset + stride(*row) * (object.sub - row->first_sub);
  }
  if (found.why == AbortCode::no_subindex && object.sub == 0) found.why = AbortCode::none;
  return found;
}

std::size_t ObjectDictionary::size(const Entry& entry, const std::uint8_t* value) {
  if (entry.type() != DataType::visible_string) return entry.size();
  const void* const end = std::memchr(value, 0, entry.extra);
  if (end == nullptr) return entry.extra;
  return static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - value);
}

AbortCode ObjectDictionary::check_range(const Entry& entry, Span<const std::uint8_t> bytes) const {
  if (entry.extra == 0) return AbortCode::none;
  const Range& range = ranges_[entry.extra - 1U];
  // Unsigned values beyond int64 are too high for every range that can be written here.
  const std::int64_t value = is_signed(entry.type())
                                 ? load_le_signed(bytes.data(), bytes.size())
                                 : static_cast<std::int64_t>(std::min<std::uint64_t>(
                                       load_le(bytes.data(), bytes.size()), INT64_MAX));
  if (value > range.high) return AbortCode::value_too_high;
  return value < range.low ? AbortCode::value_too_low : AbortCode::none;
}

AbortCode ObjectDictionary::check(const Entry& entry, Span<const std::uint8_t> bytes) const {
  if (!entry.writable()) return AbortCode::read_only;
  if (entry.type() == DataType::visible_string) {
    return bytes.size() > entry.extra ? AbortCode::too_long : AbortCode::none;
  }
  const std::size_t wanted = entry.size();
  if (bytes.size() > wanted) return AbortCode::too_long;
  if (bytes.size() < wanted) return AbortCode::too_short;
  return check_range(entry, bytes);
}

void ObjectDictionary::assign(const Entry& entry, std::uint8_t* value,
                              Span<const std::uint8_t> bytes) {
  if (!bytes.empty()) std::memcpy(value, bytes.data(), bytes.size());
  if (entry.type() != DataType::visible_string) return;
  std::memset(value + bytes.size(), 0, entry.extra - bytes.size());
}

}  // namespace volcomp::canopen
