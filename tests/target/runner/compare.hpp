#pragma once
// The comparisons behind EXPECT_ and ASSERT_: true, or the failure is begun and its values shown.

#include <cmath>
#include <cstring>

#include "tests/target/runner/outcome.hpp"

// Tests compare what they mean to compare, exactly.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-equal"
#pragma GCC diagnostic ignored "-Wsign-compare"

namespace volcomp::target {

template <class A, class B>
void show_both(Place place, const char* relation, const char* a_text, const char* b_text,
               const A& a, const B& b) {
  begin_failure(place);
  put(a_text);
  put(relation);
  put(b_text);
  put(" does not hold: ");
  print_value(a);
  put(" against ");
  print_value(b);
}

struct Equal {
  static constexpr const char* kText = " == ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a == b;
  }
};
struct NotEqual {
  static constexpr const char* kText = " != ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a != b;
  }
};
struct Less {
  static constexpr const char* kText = " < ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a < b;
  }
};
struct LessEqual {
  static constexpr const char* kText = " <= ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a <= b;
  }
};
struct Greater {
  static constexpr const char* kText = " > ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a > b;
  }
};
struct GreaterEqual {
  static constexpr const char* kText = " >= ";
  template <class A, class B>
  static bool holds(const A& a, const B& b) {
    return a >= b;
  }
};
struct SameText {
  static constexpr const char* kText = " == ";
  static bool holds(const char* a, const char* b) {
    return a == nullptr || b == nullptr ? a == b : std::strcmp(a, b) == 0;
  }
};

template <class Relation, class A, class B>
bool compare(Place place, const char* a_text, const char* b_text, const A& a, const B& b) {
  if (Relation::holds(a, b)) return true;
  show_both(place, Relation::kText, a_text, b_text, a, b);
  return false;
}

inline bool is_true(Place place, const char* text, bool value, bool wanted) {
  if (value == wanted) return true;
  begin_failure(place);
  put(text);
  put(value ? " is true" : " is false");
  return false;
}

inline bool is_near(Place place, const char* a_text, const char* b_text, double a, double b,
                    double most) {
  if (std::abs(a - b) <= most) return true;
  show_both(place, " near ", a_text, b_text, a, b);
  put(", allowed ");
  put_double(most);
  return false;
}

// Same bits but for at most four units in the last place, as in GoogleTest; NaN equals nothing.
template <class Float, class Bits>
bool almost_equal(Place place, const char* a_text, const char* b_text, Float a, Float b) {
  constexpr Bits kMost = 4;
  constexpr Bits kSign = Bits{1} << (8U * sizeof(Bits) - 1U);
  const auto ordered = [](Float value) {
    Bits bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return (bits & kSign) != 0 ? ~bits + 1U : kSign | bits;
  };
  if (a == a && b == b) {
    const Bits one = ordered(a);
    const Bits other = ordered(b);
    if ((one > other ? one - other : other - one) <= kMost) return true;
  }
  show_both(place, " == ", a_text, b_text, a, b);
  return false;
}

}  // namespace volcomp::target

#pragma GCC diagnostic pop
