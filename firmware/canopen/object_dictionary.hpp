#pragma once
// The object dictionary: a constant table of the objects, beside one plain struct that holds their
// values. Values lie in memory as they go over the bus, so mapping an object into a PDO is a copy.

#include <cstddef>
#include <cstdint>

#include "comp/core/span.hpp"
#include "firmware/canopen/object_access.hpp"

namespace volcomp::canopen {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "values are copied to the bus as they lie");

// CiA 301, table 44.
enum class DataType : std::uint8_t {
  boolean = 0x01,
  integer8 = 0x02,
  integer16 = 0x03,
  integer32 = 0x04,
  unsigned8 = 0x05,
  unsigned16 = 0x06,
  unsigned32 = 0x07,
  real32 = 0x08,
  visible_string = 0x09,
  domain = 0x0F,
  real64 = 0x11,
  integer64 = 0x15,
  unsigned64 = 0x1B,
};

// Bytes of one value; 0 for strings and domains, whose length varies.
[[nodiscard]] constexpr std::size_t size_of(DataType type) {
  switch (type) {
    case DataType::boolean:
    case DataType::integer8:
    case DataType::unsigned8:
      return 1;
    case DataType::integer16:
    case DataType::unsigned16:
      return 2;
    case DataType::integer32:
    case DataType::unsigned32:
    case DataType::real32:
      return 4;
    case DataType::real64:
    case DataType::integer64:
    case DataType::unsigned64:
      return 8;
    case DataType::visible_string:
    case DataType::domain:
      break;
  }
  return 0;
}

[[nodiscard]] constexpr bool is_signed(DataType type) {
  return type == DataType::integer8 || type == DataType::integer16 || type == DataType::integer32 ||
         type == DataType::integer64;
}

enum class Access : std::uint8_t { constant, read_only, write_only, read_write };

// What else may be done with an object.
enum Trait : std::uint8_t {
  kPlain = 0,
  kReceive = 1U << 0U,   // may be mapped into an RPDO
  kTransmit = 1U << 1U,  // may be mapped into a TPDO
  kStored = 1U << 2U,    // saved by 1010h
  kFixed = 1U << 3U,     // in OPERATIONAL, if the device wants it so
};

// Inclusive, of a writable integer; low > high: the whole type.
struct Range {
  std::int64_t low = 0;
  std::int64_t high = -1;

  [[nodiscard]] constexpr bool limited() const { return low <= high; }
};

// One row: a value, or the elements first_sub…last_sub of an array that follow each other in
// memory. Sub-index 0 of an index whose rows start at 1 needs no row: it is the highest sub-index.
// Eight bytes: a node has up to 250 of them in its flash.
struct Entry {
  std::uint16_t index;
  std::uint8_t first_sub;
  std::uint8_t last_sub;
  std::uint32_t offset : 13;  // of the first element in the struct of values
  std::uint32_t extra : 8;    // bytes of a visible string, or number of the range, from 1; 0: whole
  std::uint32_t type_bits : 5;
  std::uint32_t access_bits : 2;
  std::uint32_t traits : 4;

  [[nodiscard]] constexpr DataType type() const { return static_cast<DataType>(type_bits); }
  [[nodiscard]] std::size_t size() const;  // as size_of(); not inline, for the sake of flash
  [[nodiscard]] constexpr Access access() const { return static_cast<Access>(access_bits); }
  [[nodiscard]] constexpr bool has(Trait trait) const { return (traits & trait) != 0; }
  [[nodiscard]] constexpr bool readable() const { return access() != Access::write_only; }
  [[nodiscard]] constexpr bool writable() const {
    return access() == Access::write_only || access() == Access::read_write;
  }
};

// What DictionaryOf makes. Rows sorted by index and sub-index.
struct Dictionary {
  Span<const Entry> rows;
  const Range* ranges = nullptr;
  // Bits that the application wants set when a value arrives in a PDO; nullptr: it wants none.
  std::uint32_t (*arrival)(ObjectId object) = nullptr;
};

class ObjectDictionary {
 public:
  // Offsets of the rows go into the object that `values` points at.
  ObjectDictionary(const Dictionary& dictionary, void* values)
      : rows_(dictionary.rows),
        ranges_(dictionary.ranges),
        arrival_(dictionary.arrival),
        values_(static_cast<std::uint8_t*>(values)) {}

  struct Found {
    const Entry* entry = nullptr;   // nullptr with AbortCode none: sub-index 0 of an array
    std::uint8_t* value = nullptr;  // nullptr for a domain and for such a sub-index 0
    std::uint8_t highest_sub = 0;
    AbortCode why = AbortCode::none;
  };
  // Refuses no_object, no_subindex.
  [[nodiscard]] Found find(ObjectId object) const;

  // Bytes a readable value has now: of a string up to its terminating zero.
  [[nodiscard]] static std::size_t size(const Entry& entry, const std::uint8_t* value);

  // Whether these bytes may become the value. Refuses read_only, too_long, too_short,
  // value_too_high, value_too_low.
  [[nodiscard]] AbortCode check(const Entry& entry, Span<const std::uint8_t> bytes) const;

  // Copies bytes that passed check(); a string is filled up with zeros.
  static void assign(const Entry& entry, std::uint8_t* value, Span<const std::uint8_t> bytes);

  [[nodiscard]] Span<const Entry> rows() const { return rows_; }
  [[nodiscard]] std::uint32_t arrival(ObjectId object) const {
    return arrival_ == nullptr ? 0 : arrival_(object);
  }

 private:
  [[nodiscard]] AbortCode check_range(const Entry& entry, Span<const std::uint8_t> bytes) const;

  Span<const Entry> rows_;
  const Range* ranges_;
  std::uint32_t (*arrival_)(ObjectId);
  std::uint8_t* values_;
};

}  // namespace volcomp::canopen
