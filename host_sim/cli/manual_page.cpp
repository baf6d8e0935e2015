#include "host_sim/cli/manual_page.hpp"

#include <fmt/format.h>

#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/host/io/version.hpp"

namespace volcomp::cli {
namespace {

// The code point that begins at `at`, which moves behind it. Our texts are UTF-8.
std::uint32_t code_point(const std::string& text, std::size_t& at) {
  const auto byte = [&] { return static_cast<unsigned char>(text[at++]); };
  const std::uint32_t first = byte();
  if (first < 0x80) return first;
  const std::size_t more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
  std::uint32_t value = first & (0x3FU >> more);
  for (std::size_t i = 0; i < more && at < text.size(); ++i)
    value = value << 6U | (byte() & 0x3FU);
  return value;
}

// Text as troff shows it unchanged: no request at the beginning of a line, no escapes, and a minus
// that can be copied into a shell.
std::string troff(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t c = code_point(text, at);
    if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '\n':
        out += "\n";
        break;
      default:
        out += c < 0x80 ? std::string(1, static_cast<char>(c)) : fmt::format("\\[u{:04X}]", c);
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + troff(text) + "\\fR"; }

std::string value_name(const OptionText& o) {
  switch (o.value) {
    case ValueKind::none:
      return {};
    case ValueKind::choice:
      return fmt::format("{}", fmt::join(o.choices, "|"));
    case ValueKind::number:
      return "NUMBER";
    case ValueKind::text:
      return "TEXT";
  }
  return {};
}

std::string sentence(const OptionText& o) {
  std::string text = troff(o.description);
  if (!o.default_value.empty()) text += fmt::format(" (default: {})", troff(o.default_value));
  return text + (o.required ? "; required" : "");
}

// ".TP" with the names in bold and the value in italics.
std::string option_paragraph(const OptionText& o) {
  std::vector<std::string> names;
  names.reserve(o.names.size());
  for (const std::string& name : o.names)
    names.push_back(bold(name));
  std::string line = fmt::format("{}", fmt::join(names, ", "));
  if (o.value != ValueKind::none) line += " " + italic(value_name(o));
  if (o.many) line += " \\&...";
  return fmt::format(".TP\n{}\n{}\n", line, sentence(o));
}

std::string argument_paragraph(const OptionText& o) {
  return fmt::format(".TP\n{}{}\n{}\n", italic(o.names.front()), o.many ? " \\&..." : "",
                     sentence(o));
}

// "volcomp compare [OPTIONS] MAPS..."
std::string synopsis(const CommandText& c) {
  std::string line = bold(c.name) + " [" + italic("OPTIONS") + "]";
  for (const OptionText& argument : c.arguments)
    line += " " + italic(argument.names.front()) + (argument.many ? " \\&..." : "");
  return line;
}

bool is_help(const OptionText& o) { return o.names.back() == "--help"; }

std::string command_section(const CommandText& c) {
  std::string text =
      fmt::format(".SS {}\n{}.\n.PP\n{}\n", troff(c.name), troff(c.description), synopsis(c));
  for (const OptionText& argument : c.arguments)
    text += argument_paragraph(argument);
  for (const OptionText& o : c.options) {
    if (!is_help(o)) text += option_paragraph(o);
  }
  return text;
}

constexpr const char* kStreams =
    ".SH FILES AND PIPES\n"
    "Wherever a file is read, \\fB\\-\\fR is standard input; options that write one result write "
    "it to standard output for \\fB\\-\\fR, and words for people then go to standard error.\n"
    "A result appears whole or not at all, and an earlier file survives a command that fails.\n"
    "Lengths are in mm and angles in rad unless a name says otherwise.\n";

constexpr const char* kExamples =
    ".SH EXAMPLES\n"
    "Tables from measured runs, sent to a node on a CAN bus and kept there:\n"
    ".PP\n.RS 4\n.nf\n"
    "volcomp build\\-tables \\-\\-machine m.toml \\-\\-runs x.csv y.csv z.csv \\-\\-out m.vct\n"
    "volcomp download m.vct \\-\\-can can0 \\-\\-store\n"
    ".fi\n.RE\n.PP\n"
    "The same without a file in between, and what the diagonals say before and after:\n"
    ".PP\n.RS 4\n.nf\n"
    "volcomp build\\-tables \\-\\-machine m.toml \\-\\-runs x.csv y.csv z.csv \\-\\-out \\- |\n"
    "  volcomp download \\- \\-\\-can can0\n"
    "volcomp verify before.csv after.csv \\-\\-limit\\-um 5\n"
    ".fi\n.RE\n";

}  // namespace

std::string manual_page(const CommandText& program) {
  std::string text = fmt::format(
      ".TH VOLCOMP 1 \"\" \"volcomp {}\" \"User Commands\"\n"
      ".SH NAME\nvolcomp \\- volumetric error compensation for machine tools\n"
      ".SH SYNOPSIS\n{} {} [{}] [{}]\n"
      ".SH DESCRIPTION\n{}\n.PP\n"
      "{}, {} or {} make a script for the shell that completes commands and options.\n"
      ".SH OPTIONS\n",
      host::kVersion, bold(program.name), italic("COMMAND"), italic("OPTIONS"), italic("ARGUMENTS"),
      troff(program.description), bold("volcomp completion bash"), bold("zsh"), bold("fish"));
  for (const OptionText& o : program.options)
    text += option_paragraph(o);
  text += ".SH COMMANDS\n";
  for (const CommandText* command : all_commands(program)) {
    // A command that only has others below it has no section.
    if (command->commands.empty()) text += command_section(*command);
  }
  text += kStreams;
  text += ".SH EXIT STATUS\n";
  for (const ExitCodeText& e : kExitCodes)
    text += fmt::format(".TP\n.B {}\n{}\n", number(e.code), troff(e.meaning));
  text += "Interrupted by a signal it ends by that signal, after undoing what was half done.\n";
  return text + kExamples + ".SH SEE ALSO\n\\fBvolcomp\\-node\\fR(1), \\fBcandump\\fR(1)\n";
}

}  // namespace volcomp::cli
