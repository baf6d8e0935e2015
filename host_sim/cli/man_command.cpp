// volcomp man: volcomp(1) in troff, made from the commands themselves.

#include <fmt/format.h>

#include "host_sim/cli/command_tree.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"
#include "host_sim/host/io/version.hpp"

namespace volcomp::cli {
namespace {

// Text as troff shows it unchanged: no request at the beginning of a line, no escapes, and a minus
// that can be copied into a shell.
std::string troff(const std::string& text) {
  std::string out = text.rfind('.', 0) == 0 ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\' || c == '-') {
      out += c == '-' ? "\\-" : "\\e";
    } else if (c == '\'') {
      out += "\\(aq";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + troff(text) + "\\fR"; }

// "--json TEXT", "--slope lsq|end"; "FILE ..." where there may be several.
std::string heading(const CLI::Option& o) {
  const OptionValue value = value_of(o);
  std::string text = italic(o.get_name(true));
  if (!o.get_positional()) {
    text.clear();
    for (const std::string& name : names_of(o))
      text += (text.empty() ? "" : ", ") + bold(name);
    if (value.kind == ValueKind::choice)
      text += " " + italic(CLI::detail::join(value.choices, "|"));
    if (value.kind == ValueKind::number) text += " " + italic("NUMBER");
    if (value.kind == ValueKind::text) text += " " + italic("TEXT");
  }
  return text + (o.get_items_expected_max() > 1 ? " \\&..." : "");
}

std::string paragraph(const CLI::Option& o) {
  std::string text = fmt::format(".TP\n{}\n{}", heading(o), troff(o.get_description()));
  if (!o.get_default_str().empty())
    text += fmt::format(" (default: {})", troff(o.get_default_str()));
  return text + (o.get_required() ? "; required\n" : "\n");
}

std::string command_section(const CLI::App& command) {
  const std::string name = full_name(command);
  std::string text = fmt::format(".SS {}\n{}.\n.PP\n{} [{}]", troff(name),
                                 troff(command.get_description()), bold(name), italic("OPTIONS"));
  for (const CLI::Option* argument : shown_arguments(command))
    text += " " + heading(*argument);
  text += "\n";
  for (const CLI::Option* argument : shown_arguments(command))
    text += paragraph(*argument);
  for (const CLI::Option* o : shown_options(command))
    if (o != command.get_help_ptr()) text += paragraph(*o);
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

std::string manual_page(CLI::App& program) {
  std::string text = fmt::format(
      ".TH VOLCOMP 1 \"\" \"volcomp {}\" \"User Commands\"\n"
      ".SH NAME\nvolcomp \\- volumetric error compensation for machine tools\n"
      ".SH SYNOPSIS\n{} {} [{}] [{}]\n"
      ".SH DESCRIPTION\n{}\n.PP\n"
      "{}, {} or {} make a script for the shell that completes commands and options.\n"
      ".SH OPTIONS\n",
      host::kVersion, bold(program.get_name()), italic("COMMAND"), italic("OPTIONS"),
      italic("ARGUMENTS"), troff(program.get_description()), bold("volcomp completion bash"),
      bold("zsh"), bold("fish"));
  for (const CLI::Option* o : shown_options(program))
    text += paragraph(*o);
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : all_commands(program)) {
    // A command that only has others below it has no section.
    if (commands_below(*command).empty()) text += command_section(*command);
  }
  text += kStreams;
  text += ".SH EXIT STATUS\n";
  for (const ExitCodeText& e : kExitCodes)
    text += fmt::format(".TP\n.B {}\n{}\n", number(e.code), troff(e.meaning));
  text += "Interrupted by a signal it ends by that signal, after undoing what was half done.\n";
  return text + kExamples + ".SH SEE ALSO\n\\fBvolcomp\\-node\\fR(1), \\fBcandump\\fR(1)\n";
}

}  // namespace

void add_man_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand("man", "Print the manual page (troff)");
  command->callback([&app, &code] {
    fmt::print("{}", manual_page(app));
    code = 0;
  });
}

}  // namespace volcomp::cli
