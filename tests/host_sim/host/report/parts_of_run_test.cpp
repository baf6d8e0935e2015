// Parts of a run: which draws each has, what all of them make, and files that do not belong
// together.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/report/draws_of_run.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Shard, EveryDrawIsInOnePart) {
  for (const std::size_t of : {1U, 2U, 7U, 30U}) {
    std::multiset<std::size_t> seen;
    for (std::size_t number = 1; number <= of; ++number) {
      const Shard shard{number, of};
      for (const std::size_t draw : shard.draws_of(23))
        seen.insert(draw);
    }
    ASSERT_EQ(seen.size(), 23U) << of;
    EXPECT_EQ(std::set<std::size_t>(seen.begin(), seen.end()).size(), 23U) << of;
  }
}

TEST(Shard, IsReadFromText) {
  const Shard shard = parse_shard("2/8");
  EXPECT_EQ(shard.number, 2U);
  EXPECT_EQ(shard.of, 8U);
  for (const char* wrong : {"", "2", "0/4", "5/4", "1/0", "-1/4", "1/4x", " 1/4", "1/10001", "a/b"})
    EXPECT_THAT(sim::complaint_of([&] { return parse_shard(wrong); }), HasSubstr("give K/N"))
        << wrong;
}

class Parts : public testing::Test {
 protected:
  static PartialRun part(std::vector<std::size_t> draws) {
    PartialRun run{"xyfz", 4, {{"seed", 1}}, {{"rate", 1.0 / 3.0}}, {}};
    for (const std::size_t draw : draws)
      run.draw[draw] = {{"um", 0.1 * static_cast<double>(draw) + 1e-17}};
    return run;
  }
  std::filesystem::path write(const std::string& name, const json& content) const {
    const std::filesystem::path path = folder.path() / name;
    std::ofstream(path) << content.dump();
    return path;
  }
  static std::string refusal_of(const std::vector<std::filesystem::path>& paths) {
    return sim::complaint_of([&] { return collect_parts(paths); });
  }

  TemporaryFolder folder;
};

TEST_F(Parts, MakeTheWholeInAnyOrder) {
  const auto a = write("a", partial_json(part({0, 2}), {1, 2}));
  const auto b = write("b", partial_json(part({1, 3}), {2, 2}));
  const PartialRun all = collect_parts({b, a});
  ASSERT_EQ(all.draw.size(), 4U);
  const PartialRun whole = part({0, 1, 2, 3});
  EXPECT_EQ(all.draw, whole.draw);  // to the last bit
  EXPECT_EQ(all.figures, whole.figures);
}

TEST_F(Parts, RefusesWhatDoesNotBelongTogether) {
  const auto a = write("a", partial_json(part({0, 2}), {1, 2}));
  EXPECT_THAT(refusal_of({a}), HasSubstr("2 of 4 draws are in no file, draw 2 is the first"));
  EXPECT_THAT(refusal_of({a, a}), HasSubstr("draw 1 is in another file, too"));
  PartialRun other = part({1, 3});
  other.run["seed"] = 2;
  EXPECT_THAT(refusal_of({a, write("b", partial_json(other, {2, 2}))}),
              HasSubstr("of another run than"));
  other = part({1, 3});
  other.figures["rate"] = 0.5;
  EXPECT_THAT(refusal_of({a, write("c", partial_json(other, {2, 2}))}),
              HasSubstr("\"figures\" differs"));
  EXPECT_THAT(refusal_of({write("d", json::array())}), HasSubstr("no part of a run"));
  json old = partial_json(part({0}), {1, 2});
  old["version"] = "0.0.0";
  EXPECT_THAT(refusal_of({write("e", old)}), HasSubstr("written by version 0.0.0"));
  json torn = partial_json(part({0}), {1, 2});
  torn.erase("draws");
  EXPECT_THAT(refusal_of({write("f", torn)}), HasSubstr("is missing or of another kind"));
  json negative = partial_json(part({0}), {1, 2});
  negative["draws"][0]["draw"] = -1;
  EXPECT_THAT(refusal_of({write("h", negative)}), HasSubstr("\"draw\" is no whole number"));
  const std::filesystem::path deep = folder.path() / "deep";
  std::ofstream(deep) << std::string(300'000, '[') << std::string(300'000, ']');
  EXPECT_THAT(refusal_of({deep}), HasSubstr("nested deeper"));
  json beyond = partial_json(part({0, 9}), {1, 2});
  EXPECT_THAT(refusal_of({write("g", beyond)}), HasSubstr("has draw 10 of 4"));
}

TEST_F(Parts, OfDrawsMakeTheResultsOfTheWhole) {
  const auto third_of = [](std::size_t draw, const Progress& progress) {
    progress(1.0, "");
    return static_cast<double>(draw) / 3.0;
  };
  const auto run = [&](const DrawPlan& plan) {
    return run_draws(
        plan, "draw", [](double, const std::string&) {}, third_of);
  };
  const auto to_json = [](double result) { return json{{"third", result}}; };
  const auto from_json = [](const json& draw) { return draw.at("third").get<double>(); };
  const std::vector<double> whole = run({7, {1, 1}, 1});
  EXPECT_EQ(whole, run({7, {1, 1}, 3}));
  std::vector<std::filesystem::path> files;
  for (const Shard shard : {Shard{2, 3}, Shard{3, 3}, Shard{1, 3}}) {
    const DrawPlan plan{7, shard, 2};
    const PartialRun own = part_of_draws("thirds", plan, {{"seed", 1}}, run(plan), to_json);
    files.push_back(write(std::to_string(shard.number), partial_json(own, shard)));
  }
  EXPECT_EQ(results_of_draws(collect_parts(files), from_json), whole);
  EXPECT_THAT(sim::complaint_of([&] { return results_of_draws(PartialRun{}, from_json); }),
              HasSubstr("without draws"));
}

TEST(Draws, TellWhatIsDoneOfThePartAlone) {
  std::vector<double> done;
  std::set<std::string> texts;
  const Progress progress = [&](double share, const std::string& what) {
    done.push_back(share);
    texts.insert(what);
  };
  const auto half = [](std::size_t draw, const Progress& of_draw) {
    of_draw(0.5, "");
    of_draw(1.0, "");
    return draw;
  };
  EXPECT_EQ(run_draws({4, {2, 2}, 1}, "draw", progress, half), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(done, (std::vector<double>{0.25, 0.5, 0.75, 1.0, 1.0}));
  EXPECT_EQ(texts, (std::set<std::string>{"draw 2 of 4", "draw 4 of 4", "done"}));
}

TEST(TextOfPart, SpeaksNotToTheTerminal) {
  EXPECT_EQ(text_of_part("Drehtisch Ω", "machine"), "Drehtisch Ω");
  for (const json& wrong : {json("\x1b[31m"), json("a\nb"), json(1), json()})
    EXPECT_THAT(sim::complaint_of([&] { return text_of_part(wrong, "machine"); }),
                HasSubstr("\"machine\" is unusable"));
}

}  // namespace
}  // namespace volcomp::host
