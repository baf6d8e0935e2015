#pragma once
// What the checks of the running test have found so far, and how a failure is reported.

#include <cstdint>

#include "tests/target/runner/print_value.hpp"

namespace volcomp::target {

struct Failures {
  std::uint32_t count = 0;
  bool fatal = false;  // one of them ends the test
};
[[nodiscard]] Failures& failures();  // of the running test

struct Place {
  const char* file;
  int line;
};

// Prints FILE:LINE and counts; what follows on the line is the caller's.
void begin_failure(Place place);

// The rest of the line of a failure: what stands behind `<<`. Ends the line and names the traces.
class Remark {
 public:
  Remark() = default;
  explicit Remark(Place place) { begin_failure(place); }
  Remark(const Remark&) = delete;
  Remark& operator=(const Remark&) = delete;
  ~Remark();

  template <class T>
  Remark& operator<<(const T& value) {
    if (!begun_) put(": ");
    begun_ = true;
    print_value(value);
    return *this;
  }

 private:
  bool begun_ = false;
};

// `return EndOfTest{} = Remark() << …`: an expression of type void, so that it leaves the function.
struct EndOfTest {
  void operator=(const Remark& /*remark*/) const {  // NOLINT(misc-unconventional-assign-operator)
    failures().fatal = true;
  }
};

// What SCOPED_TRACE leaves: named by every failure in its scope.
class Trace {
 public:
  Trace(Place place, const std::string& text);
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  ~Trace();

  void print() const;
  [[nodiscard]] const Trace* outer() const { return outer_; }

 private:
  Place place_;
  std::string text_;
  const Trace* outer_;
};

}  // namespace volcomp::target
