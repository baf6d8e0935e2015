// What a misspelt word is taken for.

#include <gtest/gtest.h>

#include "host_sim/host/io/nearest_word.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

TEST(NearestWord, IsAtMostTwoLettersAway) {
  const std::vector<std::string> words{"travel_mm", "travel_rad", "targets", "kappa"};
  EXPECT_EQ(nearest_word("travel_m", words), "travel_mm");
  EXPECT_EQ(nearest_word("traget", words), "");  // three: a transposition counts twice
  EXPECT_EQ(nearest_word("target", words), "targets");
  EXPECT_EQ(nearest_word("kapa", words), "kappa");
  EXPECT_EQ(nearest_word("drive", words), "");
}

TEST(NearestWord, OfAShortWordMustHaveHalfOfIt) {
  EXPECT_EQ(nearest_word("a", {"x", "yz"}), "");
  EXPECT_EQ(nearest_word("is", {"id"}), "id");
}

TEST(NearestWord, IsSaidOfAnUnknownField) {
  const auto refusal = [](const std::string& text) {
    return sim::complaint_of([&] {
      return read_toml(text, "m.toml", [](const TomlValue& root) {
        TomlSection(root, "m.toml", "the file").allow_only({"side", "convention"});
        return 0;
      });
    });
  };
  EXPECT_EQ(refusal("\nconvension = 1\n"),
            "m.toml:2: unknown field 'convension' in the file, did you mean 'convention'? (known: "
            "side, convention)");
  EXPECT_EQ(refusal("colour = 1\n"),
            "m.toml:1: unknown field 'colour' in the file (known: side, convention)");
}

}  // namespace
}  // namespace volcomp::host
