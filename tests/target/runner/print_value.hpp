#pragma once
// Values as a failed check shows them.

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include "tests/target/text.hpp"

namespace volcomp::target {

// Arrays, vectors, spans and Eigen's vectors: data() and size().
template <class T, class = void>
struct IsSequence : std::false_type {};
template <class T>
struct IsSequence<T, std::void_t<decltype(std::declval<const T&>().data()[0]),
                                 decltype(std::declval<const T&>().size())>> : std::true_type {};

template <class T>
void print_value(const T& value);

template <class T>
void print_sequence(const T& sequence) {
  constexpr std::size_t kMost = 32;
  const auto size = static_cast<std::size_t>(sequence.size());
  put('{');
  for (std::size_t i = 0; i < size && i < kMost; ++i) {
    put(i == 0 ? " " : ", ");
    print_value(sequence.data()[i]);
  }
  put(size > kMost ? ", ... }" : " }");
}

template <class T>
void print_value(const T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    put(value ? "true" : "false");
  } else if constexpr (std::is_same_v<T, char>) {
    put(value);
  } else if constexpr (std::is_enum_v<T>) {
    print_value(static_cast<std::underlying_type_t<T>>(value));
  } else if constexpr (std::is_integral_v<T>) {
    put_number(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    put_double(static_cast<double>(value));
  } else if constexpr (std::is_convertible_v<T, const char*>) {
    const char* const text = value;
    put(text == nullptr ? "(null)" : text);
  } else if constexpr (std::is_same_v<T, std::string>) {
    put(value.c_str());
  } else if constexpr (IsSequence<T>::value) {
    print_sequence(value);
  } else {
    put_unsigned(sizeof value);
    put("-byte object");
  }
}

}  // namespace volcomp::target
