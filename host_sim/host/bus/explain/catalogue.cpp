#include "host_sim/host/bus/explain/catalogue.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host_sim/host/bus/explain/object_text.hpp"

namespace volcomp::host {
namespace {

// --- the list

std::string label_of(CodeKind kind, unsigned number) {
  switch (kind) {
    case CodeKind::status_bit:
      return fmt::format("bit {}", number);
    case CodeKind::emergency:
      return fmt::format("{:04X}h", number);
    case CodeKind::abort:
      return fmt::format("{:04X} {:04X}h", number >> 16U, number & 0xFFFFU);
    case CodeKind::reason:
    case CodeKind::verdict:
      break;
  }
  return std::to_string(number);
}

// As the page has it.
std::string heading_of(const CodeEntry& e) {
  return e.name.empty() ? fmt::format("**{}** {}", e.label, e.what)
                        : fmt::format("**`{}`** ({}) {}", e.name, e.label, e.what);
}

// The rest of the line that begins with `mark`.
std::string line_of(std::string_view paragraph, std::string_view mark) {
  const std::size_t at = paragraph.find(mark);
  if (at == std::string_view::npos) return "";
  const std::string_view line = paragraph.substr(at + mark.size());
  return std::string(line.substr(0, line.find('\n')));
}

CodeEntry entry(CodeKind kind, unsigned number, const char* name, std::string what) {
  CodeEntry e{kind, number, label_of(kind, number), name, std::move(what), "", ""};
  const std::string_view page = reason_page();
  const std::size_t at = page.find("\n" + heading_of(e) + "\n");
  if (at == std::string_view::npos) return e;
  const std::string_view paragraph = page.substr(at, page.find("\n\n", at + 1) - at);
  e.why = line_of(paragraph, "\n*Why:* ");
  e.remedy = line_of(paragraph, "\n*What to do:* ");
  return e;
}

std::string sentence_of(std::string words) {
  words.front() = static_cast<char>(std::toupper(words.front()));
  return words + ".";
}

// --- text

std::string name_of(const CodeEntry& e) {
  return e.name.empty() ? e.label : fmt::format("{} ({})", e.name, e.label);
}

// --- what a user may have typed

struct Word {
  std::string text;      // as typed
  bool decimal = false;  // up to three digits
  bool has_hex = false;  // four or eight hexadecimal digits
  unsigned number = 0;
};

Word parse(const std::string& typed) {
  Word w;
  w.text = typed;
  std::string digits;
  for (const char c : typed) {
    if (c != ' ' && c != ':') digits += static_cast<char>(std::toupper(c));
  }
  const bool prefixed = digits.rfind("0X", 0) == 0;
  if (prefixed) digits.erase(0, 2);
  if (!digits.empty() && digits.back() == 'H') digits.pop_back();
  const auto parsed_as = [&](int base) {
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, w.number, base);
    return error == std::errc{} && stop == end;
  };
  if (digits.size() <= 3 && !prefixed) {
    w.decimal = parsed_as(10);
  } else if (digits.size() == 4 || digits.size() == 8) {
    w.has_hex = parsed_as(16);
  }
  return w;
}

bool means(const Word& w, const CodeEntry& e) {
  if (!e.name.empty() && e.name == w.text) return true;
  const bool small =
      e.kind == CodeKind::reason || e.kind == CodeKind::verdict || e.kind == CodeKind::status_bit;
  return small ? w.decimal && e.number == w.number : w.has_hex && e.number == w.number;
}

}  // namespace

const char* title(CodeKind kind) {
  static constexpr std::array kTitles{"Reasons", "Status bits of an axis", "Emergency codes",
                                      "Verdicts on touches", "SDO abort codes"};
  return kTitles.at(static_cast<std::size_t>(kind));
}

std::vector<CodeEntry> code_catalogue() {
  return {
#define REASON(number, name, sentence) entry(CodeKind::reason, number, #name, sentence),
#include "comp/core/reasons.def"
#define STATUS_BIT(bit, enumerator, name, NAME, words) \
  entry(CodeKind::status_bit, bit, #name, sentence_of(words)),
#include "comp/tick/codes.def"
#define ERROR_CODE(number, name, title, sentence) entry(CodeKind::emergency, number, "", sentence),
#include "firmware/canopen/codes.def"
#define VERDICT(number, name, sentence) entry(CodeKind::verdict, number, #name, sentence),
#include "comp/tick/codes.def"
#define ABORT_CODE(number, name, sentence) entry(CodeKind::abort, number, "", sentence),
#include "firmware/canopen/codes.def"
  };
}

std::string object_page() {
  std::string page =
      "# Object dictionary of the node\n\n"
      "Made from the code by `volcomp device-files --objects FILE`; the same as "
      "[volcomp.eds](../firmware/volcomp.eds), for people. `volcomp explain 2202h` shows one "
      "object. [firmware/README.md](../firmware/README.md) tells how they work together.\n\n"
      "Access: ro read only, rw read and write, rwr also in a TPDO, rww also in an RPDO. Defaults "
      "are those of a node that was never configured.\n";
  for (const std::vector<EdsObject>& alike : objects_alike())
    page += object_section(alike);
  return page;
}

Meaning meaning_of(const std::string& typed) {
  const Word word = parse(typed);
  Meaning meaning;
  for (const CodeEntry& e : code_catalogue()) {
    if (means(word, e)) meaning.codes.push_back(e);
  }
  if (!word.has_hex) return meaning;
  for (const EdsObject& object : node_eds_objects()) {
    if (object.index == word.number) meaning.objects.push_back(object);
  }
  return meaning;
}

std::string meaning_text(const Meaning& meaning) {
  std::string text;
  for (const CodeEntry& e : meaning.codes) {
    text += fmt::format("{}: {}\n  {}\n", title(e.kind), name_of(e), e.what);
    if (!e.why.empty()) text += fmt::format("  Why: {}\n", e.why);
    if (!e.remedy.empty()) text += fmt::format("  What to do: {}\n", e.remedy);
  }
  for (const EdsObject& object : meaning.objects)
    text += object_text(object);
  return text;
}

}  // namespace volcomp::host
