#pragma once
// The part of GoogleTest that the unit tests of comp use, for boards: no exceptions, no type
// information, no static constructors. The include path of the test images finds it in the place of
// <gtest/gtest.h>, so that the very same test files run on the host and on a board.
//
//   TEST, TEST_F with SetUp and TearDown
//   EXPECT_ and ASSERT_ TRUE FALSE EQ NE LT LE GT GE NEAR FLOAT_EQ DOUBLE_EQ STREQ
//   FAIL, ADD_FAILURE, SCOPED_TRACE, RecordProperty of integers, HasFatalFailure
//   << behind each of them

#include <memory>

#include "tests/target/runner/compare.hpp"
#include "tests/target/runner/test_case.hpp"

// For what a test has to do otherwise here, such as trying fewer points.
#define VOLCOMP_GTEST_SUBSET 1

namespace testing {

class Test {
 public:
  Test() = default;
  Test(const Test&) = delete;
  Test& operator=(const Test&) = delete;
  virtual ~Test() = default;

  // Named so that no test means another function by it.
  void RunWholeTest() {
    SetUp();
    if (!HasFatalFailure()) TestBody();
    TearDown();
  }
  static bool HasFatalFailure() { return volcomp::target::failures().fatal; }

 protected:
  virtual void SetUp() {}
  virtual void TearDown() {}
  template <class Integer>
  static void RecordProperty(const char* name, Integer value) {
    volcomp::target::put("  ");
    volcomp::target::put_field(name, value);
    volcomp::target::put('\n');
  }

 private:
  virtual void TestBody() = 0;
};

}  // namespace testing

// --- tests ---------------------------------------------------------------------------------------

#define VOLCOMP_TEST(suite, name, fixture)                                               \
  class suite##_##name##_Test : public fixture {                                         \
    void TestBody() override;                                                            \
  };                                                                                     \
  [[gnu::section(".test_cases"),                                                         \
    gnu::used]] static constexpr ::volcomp::target::TestCase suite##_##name##_case{      \
      #suite, #name, [] { std::make_unique<suite##_##name##_Test>()->RunWholeTest(); }}; \
  void suite##_##name##_Test::TestBody()

#define TEST(suite, name) VOLCOMP_TEST(suite, name, ::testing::Test)
#define TEST_F(suite, name) VOLCOMP_TEST(suite, name, suite)

// --- checks --------------------------------------------------------------------------------------

// `condition` has begun the report when it is false. The switch keeps an `else` of the test from
// binding to the one here.
#define VOLCOMP_EXPECT(condition) \
  switch (0)                      \
  case 0:                         \
  default:                        \
    if (condition)                \
      ;                           \
    else                          \
      ::volcomp::target::Remark()

#define VOLCOMP_ASSERT(condition) \
  switch (0)                      \
  case 0:                         \
  default:                        \
    if (condition)                \
      ;                           \
    else                          \
      return ::volcomp::target::EndOfTest{} = ::volcomp::target::Remark()

#define VOLCOMP_HERE \
  ::volcomp::target::Place { __FILE__, __LINE__ }
#define VOLCOMP_COMPARE(relation, a, b) \
  ::volcomp::target::compare<::volcomp::target::relation>(VOLCOMP_HERE, #a, #b, a, b)
#define VOLCOMP_TRUE(a, wanted) \
  ::volcomp::target::is_true(VOLCOMP_HERE, #a, static_cast<bool>(a), wanted)
#define VOLCOMP_NEAR(a, b, most)                                                                   \
  ::volcomp::target::is_near(VOLCOMP_HERE, #a, #b, static_cast<double>(a), static_cast<double>(b), \
                             static_cast<double>(most))
#define VOLCOMP_ALMOST(type, bits, a, b) \
  ::volcomp::target::almost_equal<type, bits>(VOLCOMP_HERE, #a, #b, a, b)

#define EXPECT_TRUE(a) VOLCOMP_EXPECT(VOLCOMP_TRUE(a, true))
#define EXPECT_FALSE(a) VOLCOMP_EXPECT(VOLCOMP_TRUE(a, false))
#define EXPECT_EQ(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(Equal, a, b))
#define EXPECT_NE(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(NotEqual, a, b))
#define EXPECT_LT(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(Less, a, b))
#define EXPECT_LE(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(LessEqual, a, b))
#define EXPECT_GT(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(Greater, a, b))
#define EXPECT_GE(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(GreaterEqual, a, b))
#define EXPECT_STREQ(a, b) VOLCOMP_EXPECT(VOLCOMP_COMPARE(SameText, a, b))
#define EXPECT_NEAR(a, b, most) VOLCOMP_EXPECT(VOLCOMP_NEAR(a, b, most))
#define EXPECT_FLOAT_EQ(a, b) VOLCOMP_EXPECT(VOLCOMP_ALMOST(float, std::uint32_t, a, b))
#define EXPECT_DOUBLE_EQ(a, b) VOLCOMP_EXPECT(VOLCOMP_ALMOST(double, std::uint64_t, a, b))
#define ADD_FAILURE() ::volcomp::target::Remark(VOLCOMP_HERE)

#define ASSERT_TRUE(a) VOLCOMP_ASSERT(VOLCOMP_TRUE(a, true))
#define ASSERT_FALSE(a) VOLCOMP_ASSERT(VOLCOMP_TRUE(a, false))
#define ASSERT_EQ(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(Equal, a, b))
#define ASSERT_NE(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(NotEqual, a, b))
#define ASSERT_LT(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(Less, a, b))
#define ASSERT_LE(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(LessEqual, a, b))
#define ASSERT_GT(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(Greater, a, b))
#define ASSERT_GE(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(GreaterEqual, a, b))
#define ASSERT_STREQ(a, b) VOLCOMP_ASSERT(VOLCOMP_COMPARE(SameText, a, b))
#define ASSERT_NEAR(a, b, most) VOLCOMP_ASSERT(VOLCOMP_NEAR(a, b, most))
#define ASSERT_FLOAT_EQ(a, b) VOLCOMP_ASSERT(VOLCOMP_ALMOST(float, std::uint32_t, a, b))
#define ASSERT_DOUBLE_EQ(a, b) VOLCOMP_ASSERT(VOLCOMP_ALMOST(double, std::uint64_t, a, b))
#define FAIL() return ::volcomp::target::EndOfTest{} = ::volcomp::target::Remark(VOLCOMP_HERE)

// --- traces --------------------------------------------------------------------------------------

#define VOLCOMP_JOINED(a, b) a##b
#define VOLCOMP_NAMED(a, b) VOLCOMP_JOINED(a, b)
#define SCOPED_TRACE(text) \
  const ::volcomp::target::Trace VOLCOMP_NAMED(volcomp_trace_, __LINE__)(VOLCOMP_HERE, text)
