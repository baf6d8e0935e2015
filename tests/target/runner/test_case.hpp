#pragma once
// The tests of an image: constants in a section of their own; the linker script marks its ends.

namespace volcomp::target {

struct TestCase {
  const char* suite;
  const char* name;
  void (*run)();
};

}  // namespace volcomp::target

extern "C" {
extern const volcomp::target::TestCase test_cases_begin;
extern const volcomp::target::TestCase test_cases_end;
}
