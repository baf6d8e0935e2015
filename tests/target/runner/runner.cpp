// Runs the tests of an image one after the other and reports which failed. Exit codes: 0 all
// passed, 1 one failed, 2 other tests than the build meant to link.

#include "tests/target/runner/outcome.hpp"
#include "tests/target/runner/test_case.hpp"

// Made by the linker: its address is how many tests the sources of this image contain.
extern "C" const char volcomp_tests_expected;

namespace volcomp::target {
namespace {

Failures current;
const Trace* innermost = nullptr;

void put_place(Place place) {
  put(place.file);
  put(':');
  put_signed(place.line);
  put(": ");
}

void put_name(const char* verdict, const TestCase& test) {
  put(verdict);
  put(test.suite);
  put('.');
  put(test.name);
  put('\n');
}

bool passes(const TestCase& test) {
  current = {};
  put_name("[ RUN      ] ", test);
  test.run();
  const bool passed = current.count == 0;
  put_name(passed ? "[       OK ] " : "[  FAILED  ] ", test);
  return passed;
}

void put_count(const char* verdict, std::uint32_t tests) {
  put(verdict);
  put_unsigned(tests);
  put(tests == 1 ? " test\n" : " tests\n");
}

}  // namespace

Failures& failures() { return current; }

void begin_failure(Place place) {
  ++current.count;
  put_place(place);
  put("Failure: ");
}

Remark::~Remark() {
  put('\n');
  for (const Trace* trace = innermost; trace != nullptr; trace = trace->outer())
    trace->print();
}

Trace::Trace(Place place, const std::string& text) : place_(place), text_(text), outer_(innermost) {
  innermost = this;
}
Trace::~Trace() { innermost = outer_; }

void Trace::print() const {
  put("  trace ");
  put_place(place_);
  put(text_.c_str());
  put('\n');
}

}  // namespace volcomp::target

int main() {
  using namespace volcomp::target;  // NOLINT(google-build-using-namespace)
  start_text();
  std::uint32_t run = 0;
  std::uint32_t failed = 0;
  // GCC lays out the constants of a file from the last to the first.
  for (const TestCase* test = &test_cases_end; test != &test_cases_begin;) {
    ++run;
    if (!passes(*--test)) ++failed;
  }
  put_count("[==========] ", run);
  put_count("[  PASSED  ] ", run - failed);
  if (failed > 0) put_count("[  FAILED  ] ", failed);
  const auto expected = reinterpret_cast<std::uintptr_t>(&volcomp_tests_expected);
  if (run != expected) {
    put("The sources of this image contain another number of tests: ");
    put_unsigned(expected);
    put(".\n");
    return 2;
  }
  return failed == 0 ? 0 : 1;
}
