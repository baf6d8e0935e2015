#include "host_sim/host/report/parts_of_run.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/version.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "volcomp-part-1";
constexpr std::size_t kMostBytes = std::size_t{64} << 20U;
constexpr int kDeepest = 8;  // of brackets: copies and comparisons call themselves
constexpr std::size_t kMostDraws = 1'000'000;

bool read_count(std::string_view text, std::size_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

[[noreturn]] void refuse_file(const std::string& name, const std::string& why) {
  throw UserError(fmt::format("{}: {}", name, why));
}

json read_part(const std::filesystem::path& path) {
  InputFile file(path);
  bool too_deep = false;
  const auto limit = [&too_deep](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  json part = json::parse(file.beginning(kMostBytes), limit, false);
  if (too_deep) refuse_file(file.name(), "nested deeper than any part of a run");
  if (!part.is_object() || part.value("format", "") != kFormat)
    refuse_file(file.name(), "this is no part of a run that --shard has written");
  if (part.value("version", "") != kVersion)
    refuse_file(file.name(), fmt::format("written by version {}, this is {}",
                                         part.value("version", "?"), kVersion));
  return part;
}

std::size_t count_of(const std::string& name, const json& value, const char* what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMostDraws)
    refuse_file(name, fmt::format("\"{}\" is no whole number from 0 to {}", what, kMostDraws));
  return value.get<std::size_t>();
}

void take_draws(const std::string& name, const json& part, PartialRun& all) {
  for (const json& draw : part.at("draws")) {
    const std::size_t number = count_of(name, draw.at("draw"), "draw");
    if (number >= all.draws)
      refuse_file(name, fmt::format("has draw {} of {}", number + 1, all.draws));
    if (!all.draw.emplace(number, draw.at("result")).second)
      refuse_file(name, fmt::format("draw {} is in another file, too", number + 1));
  }
}

void require_complete(const PartialRun& all) {
  if (all.draw.size() == all.draws) return;
  std::size_t missing = 0;
  while (all.draw.count(missing) != 0)
    ++missing;
  throw UserError(fmt::format("{} of {} draws are in no file, draw {} is the first",
                              all.draws - all.draw.size(), all.draws, missing + 1));
}

}  // namespace

std::vector<std::size_t> Shard::draws_of(std::size_t all) const {
  std::vector<std::size_t> own;
  for (std::size_t draw = number - 1; draw < all; draw += of)
    own.push_back(draw);
  return own;
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  const bool read = slash != std::string::npos &&
                    read_count(std::string_view(text).substr(0, slash), shard.number) &&
                    read_count(std::string_view(text).substr(slash + 1), shard.of);
  if (!read || shard.number < 1 || shard.number > shard.of || shard.of > kMostShards)
    throw UserError(fmt::format("--shard {}: give K/N, part K of N, for instance 1/8", text));
  return shard;
}

json hashes_of(const std::vector<HashedInput>& inputs) {
  json hashes = json::array();
  for (const HashedInput& input : inputs)
    hashes.push_back(json::array({input.what, input.sha256}));
  return hashes;
}

std::string text_of_part(const json& value, const char* what) {
  const auto is_control = [](char byte) { return static_cast<unsigned char>(byte) < ' '; };
  std::string text = value.is_string() ? value.get<std::string>() : "";
  if (!value.is_string() || std::any_of(text.begin(), text.end(), is_control))
    throw UserError(fmt::format("a part of the run: \"{}\" is unusable", what));
  return text;
}

json partial_json(const PartialRun& part, const Shard& shard) {
  json draws = json::array();
  for (const auto& [number, result] : part.draw)
    draws.push_back({{"draw", number}, {"result", result}});
  return {{"format", kFormat},
          {"version", kVersion},
          {"experiment", part.experiment},
          {"shard", {{"number", shard.number}, {"of", shard.of}}},
          {"draws_of_run", part.draws},
          {"run", part.run},
          {"figures", part.figures},
          {"draws", draws}};
}

PartialRun collect_parts(const std::vector<std::filesystem::path>& paths) {
  PartialRun all;
  json first;
  for (const std::filesystem::path& path : paths) {
    const std::string name = shown_name(path);
    try {
      const json part = read_part(path);
      if (first.is_null()) {
        first = part;
        all = {part.at("experiment").get<std::string>(),
               count_of(name, part.at("draws_of_run"), "draws_of_run"),
               part.at("run"),
               part.at("figures"),
               {}};
        if (part.contains("transport")) all.figures["transport"] = part["transport"];
      }
      for (const char* alike : {"experiment", "draws_of_run", "run", "figures", "transport"}) {
        if (part.value(alike, json()) == first.value(alike, json())) continue;
        refuse_file(name, fmt::format("of another run than {}: \"{}\" differs",
                                      shown_name(paths.front()), alike));
      }
      take_draws(name, part, all);
    } catch (const json::exception&) {
      refuse_file(name, "a member of this part of a run is missing or of another kind");
    }
  }
  require_complete(all);
  return all;
}

}  // namespace volcomp::host
