#include "host_sim/host/bus/explain/catalogue.hpp"

#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "comp/tick/status_text.hpp"
#include "firmware/canopen/abort_code.hpp"
#include "host_sim/host/bus/explain/explanation.hpp"
#include "host_sim/host/bus/explain/object_text.hpp"

namespace volcomp::host {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;

CodeEntry entry(CodeKind kind, unsigned number, std::string label, std::string name,
                std::string what, const Explanation& text) {
  return {kind, number, std::move(label), std::move(name), std::move(what), text.why, text.remedy};
}

// There is no list of them in the code: those that have a sentence of their own.
template <class Code>
std::vector<Code> known_codes(unsigned from, unsigned to, const std::string& unknown) {
  std::vector<Code> codes;
  for (unsigned n = from; n <= to; ++n) {
    const auto code = static_cast<Code>(n);
    if (sentence(code) != unknown) codes.push_back(code);
  }
  return codes;
}

void add_emergencies(std::vector<CodeEntry>& all) {
  const std::string unknown = sentence(static_cast<ErrorCode>(0xFFFF));
  for (const ErrorCode code : known_codes<ErrorCode>(0, 0xFFFE, unknown)) {
    const auto number = static_cast<unsigned>(code);
    all.push_back(entry(CodeKind::emergency, number, fmt::format("{:04X}h", number), "",
                        sentence(code), explain(code)));
  }
}

void add_aborts(std::vector<CodeEntry>& all) {
  const std::string unknown = sentence(static_cast<AbortCode>(0xFFFFFFFF));
  std::vector<AbortCode> codes;
  for (unsigned block = 0x05030000; block <= 0x08000000; block += 0x10000) {
    for (const AbortCode code : known_codes<AbortCode>(block, block + 0xFF, unknown))
      codes.push_back(code);
  }
  for (const AbortCode code : codes) {
    const auto number = static_cast<unsigned>(code);
    all.push_back(entry(CodeKind::abort, number,
                        fmt::format("{:04X} {:04X}h", number >> 16U, number & 0xFFFFU), "",
                        sentence(code), {}));
  }
}

// --- text

std::string name_of(const CodeEntry& e) {
  return e.name.empty() ? e.label : fmt::format("{} ({})", e.name, e.label);
}

void append_kind(std::string& page, const std::vector<CodeEntry>& all, CodeKind kind,
                 const char* introduction) {
  page += fmt::format("\n## {}\n\n{}\n", title(kind), introduction);
  for (const CodeEntry& e : all) {
    if (e.kind != kind) continue;
    page += e.name.empty() ? fmt::format("\n**{}** {}", e.label, e.what)
                           : fmt::format("\n**`{}`** ({}) {}", e.name, e.label, e.what);
    if (!e.why.empty()) page += fmt::format("\n*Why:* {}", e.why);
    if (!e.remedy.empty()) page += fmt::format("\n*What to do:* {}", e.remedy);
    page += '\n';
  }
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
  switch (kind) {
    case CodeKind::reason:
      return "Reasons";
    case CodeKind::status_bit:
      return "Status bits of an axis";
    case CodeKind::emergency:
      return "Emergency codes";
    case CodeKind::verdict:
      return "Verdicts on touches";
    case CodeKind::abort:
      return "SDO abort codes";
  }
  return "";
}

std::vector<CodeEntry> code_catalogue() {
  std::vector<CodeEntry> all;
  for (unsigned n = 0; n < kReasons; ++n) {
    const auto reason = static_cast<Reason>(n);
    all.push_back(entry(CodeKind::reason, n, fmt::format("{}", n), code(reason), sentence(reason),
                        explain(reason)));
  }
  for (unsigned n = 0; n < kStatusBits; ++n) {
    const auto bit = static_cast<StatusBit>(1U << n);
    const std::string text = words(bit);
    all.push_back(entry(CodeKind::status_bit, n, fmt::format("bit {}", n), code(bit),
                        static_cast<char>(std::toupper(text.front())) + text.substr(1) + ".",
                        explain(bit)));
  }
  add_emergencies(all);
  for (unsigned n = 0; n < kTouchVerdicts; ++n) {
    const auto verdict = static_cast<TouchVerdict>(n);
    all.push_back(entry(CodeKind::verdict, n, fmt::format("{}", n), code(verdict),
                        sentence(verdict), explain(verdict)));
  }
  add_aborts(all);
  return all;
}

std::string reason_page() {
  const std::vector<CodeEntry> all = code_catalogue();
  std::string page =
      "# What volcomp says, and what to do\n\n"
      "Made from the code by `volcomp device-files --reasons FILE`; `volcomp explain CODE` shows "
      "one of them.\n";
  append_kind(page, all, CodeKind::reason,
              "Why an input was refused. The host tool adds file, line, axis, run or field; a node "
              "tells the number in 2112h:02 and in the emergency FF10h. What was in force stays in "
              "force.");
  append_kind(
      page, all, CodeKind::status_bit,
      "2601h, one word per axis; 2600h:03 is all of them together. 2610h to 2614h count how "
      "often each began.");
  append_kind(page, all, CodeKind::emergency,
              "Sent once when an error appears, and once more as 0000h when it has gone. The last "
              "eight are in 1003h. Bytes are counted from 0.");
  append_kind(page, all, CodeKind::verdict, "2401h:02, and in the emergency FF30h.");
  append_kind(page, all, CodeKind::abort, "Answers to an SDO request (CiA 301).");
  return page;
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
