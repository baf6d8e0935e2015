// volcomp explain CODE…

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/output.hpp"
#include "host_sim/host/bus/explain/meaning_json.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::cli {
namespace {

struct ExplainArguments {
  std::vector<std::string> words;
  std::string json_file;
};

struct Answer {
  std::string text;
  nlohmann::json figures;
};

Answer explain_words(const std::vector<std::string>& words) {
  Answer answer{"", {{"words", nlohmann::json::array()}}};
  for (const std::string& word : words) {
    const host::Meaning meaning = host::meaning_of(word);
    const std::string found = host::meaning_text(meaning);
    if (found.empty()) {
      throw host::UserError(fmt::format(
          "nothing is known of \"{}\" (a name such as crc_mismatch, the number of a reason such as "
          "20, an "
          "emergency code or object such as FF10h or 2202h, an abort code such as 06010002)",
          word));
    }
    answer.text += (answer.text.empty() ? "" : "\n") + found;
    answer.figures["words"].push_back(host::meaning_json(word, meaning));
  }
  return answer;
}

Answer list_words() {
  Answer answer{"", host::catalogue_json()};
  const char* heading = "";
  for (const host::CodeEntry& e : host::code_catalogue()) {
    if (heading != host::title(e.kind))
      answer.text += fmt::format("{}{}\n", *heading == '\0' ? "" : "\n", host::title(e.kind));
    heading = host::title(e.kind);
    answer.text += fmt::format("  {:<12} {:<24} {}\n", e.label, e.name, e.what);
  }
  return answer;
}

int tell(const ExplainArguments& a) {
  Results results({a.json_file});
  const Answer answer = a.words.empty() ? list_words() : explain_words(a.words);
  results.add(a.json_file, json_text(answer.figures));
  results.write();
  fmt::print(results.text(), "{}", answer.text);
  return 0;
}

}  // namespace

void add_explain_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand(
      "explain",
      "Say what a reason, status bit, emergency code, object or abort code means, and what to do");
  auto a = std::make_shared<ExplainArguments>();
  command->add_option(
      "CODE", a->words,
      "Names or numbers as they were told: crc_mismatch, 20, FF10h, 2202h, 06010002; without "
      "any, all codes are listed");
  command->add_option("--json", a->json_file, "Write it to this file, too (-: standard output)");
  command->callback([a, &code] { code = tell(*a); });
}

}  // namespace volcomp::cli
