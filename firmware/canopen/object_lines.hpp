#pragma once
// What the lines of a dictionary become (communication.def, firmware/node/objects.def): members of
// a structure, rows and handles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "firmware/canopen/named_entry.hpp"

namespace volcomp::canopen::object_lines {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using i8 = std::int8_t;
using i16 = std::int16_t;
using i32 = std::int32_t;
using i64 = std::int64_t;
using f32 = float;
using f64 = double;
using text = char;

// One value, or an array of them.
template <class T, std::size_t count>
using Values = std::conditional_t<count == 1, T, std::array<T, count>>;

// The same default for every value of an array.
template <class Value>
struct Each {
  Value value;
  template <class T, std::size_t count>
  constexpr operator std::array<T, count>() const {  // NOLINT(google-explicit-constructor)
    std::array<T, count> all{};
    for (T& one : all)
      one = static_cast<T>(value);
    return all;
  }
};
template <class Value>
constexpr Each<Value> each(Value value) {
  return {value};
}

template <class T>
constexpr DataType type_of() {
  if (std::is_same_v<T, text>) return DataType::visible_string;
  if (std::is_same_v<T, f32>) return DataType::real32;
  if (std::is_same_v<T, f64>) return DataType::real64;
  constexpr std::size_t k = sizeof(T);
  if (std::is_signed_v<T>) {
    return k == 1   ? DataType::integer8
           : k == 2 ? DataType::integer16
           : k == 4 ? DataType::integer32
                    : DataType::integer64;
  }
  return k == 1   ? DataType::unsigned8
         : k == 2 ? DataType::unsigned16
         : k == 4 ? DataType::unsigned32
                  : DataType::unsigned64;
}

struct Use {
  Access access;
  std::uint8_t traits;  // of Trait
};
inline constexpr Use constant{Access::constant, kPlain};
inline constexpr Use stored{Access::read_write, kStored};
inline constexpr Use fixed{Access::read_write, kStored | kFixed};
inline constexpr Use written{Access::read_write, kPlain};
inline constexpr Use received{Access::read_write, kReceive};
inline constexpr Use sent{Access::read_only, kTransmit};
inline constexpr Use both{Access::read_write, kReceive | kTransmit};
inline constexpr Use read{Access::read_only, kPlain};

inline constexpr Range any{0, -1};  // the whole type
constexpr Range range(std::int64_t low, std::int64_t high) { return {low, high}; }

// Where a value of type T, or the first of several, stands in the dictionary.
template <class T>
struct Handle {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint8_t count;  // of values, or bytes of a text
  const char* name;
  const char* member;  // of its structure

  // A constructor, so that no {index, sub} of an ObjectId becomes one.
  constexpr Handle(std::uint16_t i, std::size_t s, std::size_t c, const char* n, const char* m = "")
      : index(i),
        sub(static_cast<std::uint8_t>(s)),
        count(static_cast<std::uint8_t>(c)),
        name(n),
        member(m) {}
  // One of several, from 0.
  [[nodiscard]] constexpr Handle operator[](std::size_t which) const {
    return {index, sub + which, count, name, member};
  }
  // Of one value, or of the text.
  [[nodiscard]] constexpr std::size_t bytes() const {
    return std::is_same_v<T, text> ? count : sizeof(T);
  }
  [[nodiscard]] constexpr ObjectId id() const { return {index, sub}; }
  // As a PDO maps it.
  [[nodiscard]] constexpr std::uint32_t mapped() const {
    return canopen::mapped(index, sub, 8 * sizeof(T));
  }
};

// A value at `offset` of its structure.
template <class T>
constexpr NamedEntry row(std::uint16_t index, std::size_t first_sub, std::size_t count,
                         std::size_t offset, Use use, Range range, const char* name) {
  const bool is_text = std::is_same_v<T, text>;
  const std::size_t last_sub = first_sub + (is_text ? 1 : count) - 1;
  return {index,
          static_cast<std::uint8_t>(first_sub),
          static_cast<std::uint8_t>(last_sub),
          type_of<T>(),
          use.access,
          use.traits,
          static_cast<std::uint16_t>(offset),
          static_cast<std::uint16_t>(is_text ? count : 0),
          name,
          range.low,
          range.high};
}

// What a handler reads or writes.
constexpr NamedEntry domain(std::uint16_t index, std::size_t first_sub, std::size_t count, Use use,
                            const char* name) {
  NamedEntry entry = row<u8>(index, first_sub, count, 0, use, any, name);
  entry.type = DataType::domain;
  return entry;
}

}  // namespace volcomp::canopen::object_lines

namespace volcomp {
using canopen::object_lines::each;
}

// A line as a member of its structure.
// NOLINTBEGIN(bugprone-macro-parentheses): the name of a member
#define OBJECT_MEMBER(index, sub, count, type, member, use, value, range, name)                  \
  ::volcomp::canopen::object_lines::Values<::volcomp::canopen::object_lines::type, count> member \
      value;
// NOLINTEND(bugprone-macro-parentheses)
// A line as a handle.
#define OBJECT_HANDLE(index, sub, count, type, member, use, value, range, name) \
  inline constexpr ::volcomp::canopen::object_lines::Handle<                    \
      ::volcomp::canopen::object_lines::type>                                   \
      member{index, sub, count, name, #member};
