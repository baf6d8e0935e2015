// An image that claims one test more than it has.

#include <gtest/gtest.h>

namespace {

TEST(Passes, ByItself) { EXPECT_TRUE(true); }

}  // namespace
