#pragma once
// All names and numbers that a volcomp machine reports, in one list, and the pages about them.
//
// Name, number and sentence come from reasons.def, codes.def and objects.def; why a code comes and
// what to do stands in docs/reason-codes.md, a page written by hand, which is linked into the
// program.

#include <string>
#include <string_view>
#include <vector>

#include "host_sim/host/bus/device_files/eds_objects.hpp"

namespace volcomp::host {

enum class CodeKind { reason, status_bit, emergency, verdict, abort };

struct CodeEntry {
  CodeKind kind = CodeKind::reason;
  unsigned number = 0;
  std::string label;   // the number as it is written: 7, bit 3, FF10h, 0601 0002h
  std::string name;    // machine-readable; empty where there is none
  std::string what;    // what happened
  std::string why;     // empty for abort codes
  std::string remedy;  // likewise
};

[[nodiscard]] std::vector<CodeEntry> code_catalogue();

[[nodiscard]] const char* title(CodeKind kind);

// Markdown. docs/reason-codes.md, and what docs/object-dictionary.md is made from.
[[nodiscard]] std::string_view reason_page();
[[nodiscard]] std::string object_page();

struct Meaning {
  std::vector<CodeEntry> codes;
  std::vector<EdsObject> objects;
};

// Explains a word: a name ("crc_mismatch"), the number of a reason or verdict ("20"), an emergency
// code or object ("FF10h", "0x2202"), an abort code ("06010002"). Empty if nothing is.
[[nodiscard]] Meaning meaning_of(const std::string& typed);
[[nodiscard]] std::string meaning_text(const Meaning& meaning);

}  // namespace volcomp::host
