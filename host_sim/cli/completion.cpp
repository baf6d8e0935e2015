#include "host_sim/cli/completion.hpp"

#include <cstddef>
#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/command_tree.hpp"
#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/exit_codes.hpp"

namespace volcomp::cli {
namespace {

// bash and fish take the words for their own, zsh wants a colon before a description. The program
// is called as the user has typed it, for it need not be in the PATH.
constexpr const char* kBash =
    R"sh(# bash completion of volcomp; made by: volcomp completion bash
_volcomp() {
  local offered
  COMPREPLY=()
  offered=$("${COMP_WORDS[0]/#\~\//$HOME/}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null) || return 0
  compopt +o default
  mapfile -t COMPREPLY < <(compgen -W "$(cut -f 1 <<<"$offered")" -- "${COMP_WORDS[COMP_CWORD]}")
}
complete -o default -F _volcomp volcomp
)sh";

constexpr const char* kZsh =
    R"sh(#compdef volcomp
# zsh completion of volcomp; made by: volcomp completion zsh
_volcomp() {
  local lines
  lines=$("${words[1]/#\~\//$HOME/}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null) || { _files; return }
  [[ -n $lines ]] || { _message 'a number'; return }
  local -a offered=("${(@)${(f)lines}/$'\t'/:}")
  _describe volcomp offered
}
if [[ ${funcstack[1]} == _volcomp ]]; then _volcomp "$@"; else compdef _volcomp volcomp; fi
)sh";

constexpr const char* kFish =
    R"sh(# fish completion of volcomp; made by: volcomp completion fish
function __volcomp_complete
    set -l words (string replace -r -- '^~/' $HOME/ (commandline -opc))
    set -l current (commandline -ct)
    $words[1] __complete $words[2..-1] "$current" 2>/dev/null
end
complete -c volcomp -n '__volcomp_complete >/dev/null' -f -a '(__volcomp_complete)'
)sh";

int print_files() { return number(ExitCode::negative); }

// `begin`: what the word has before its value, "--slope=".
int print_values(const OptionValue& value, const std::string& begin) {
  if (value.kind == ValueKind::text) return print_files();
  for (const std::string& choice : value.choices)
    fmt::print("{}{}\n", begin, choice);
  return number(ExitCode::done);
}

int print_options(const CLI::App& command) {
  for (const CLI::Option* option : shown_options(command))
    for (const std::string& name : names_of(*option))
      fmt::print("{}\t{}\n", name, option->get_description());
  return number(ExitCode::done);
}

int print_commands(const CLI::App& command) {
  bool any = false;
  for (const CLI::App* below : commands_below(command)) {
    fmt::print("{}\t{}\n", below->get_name(), below->get_description());
    any = true;
  }
  for (const CLI::Option* argument : shown_arguments(command)) {
    for (const std::string& choice : value_of(*argument).choices) {
      fmt::print("{}\n", choice);
      any = true;
    }
  }
  return any ? number(ExitCode::done) : print_files();
}

}  // namespace

int print_candidates(const CLI::App& program, std::vector<std::string> words) {
  const std::string current = words.empty() ? "" : words.back();
  if (!words.empty()) words.pop_back();
  const CLI::App* command = &program;
  for (const std::string& word : words)
    if (const CLI::App* below = command_named(*command, word); below != nullptr) command = below;
  const auto value_after = [&](const std::string& word) {
    const CLI::Option* option =
        word.rfind('-', 0) == 0 ? command->get_option_no_throw(word) : nullptr;
    return option != nullptr ? value_of(*option) : OptionValue{};
  };
  const OptionValue value = words.empty() ? OptionValue{} : value_after(words.back());
  if (value.kind != ValueKind::none) return print_values(value, "");
  if (current.rfind('-', 0) != 0) return print_commands(*command);
  const std::size_t equals = current.find('=');
  if (equals == std::string::npos) return print_options(*command);
  return print_values(value_after(current.substr(0, equals)), current.substr(0, equals + 1));
}

void add_completion_command(CLI::App& app, int& code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes the commands in a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "Whose: bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell, &code] {
    fmt::print("{}", *shell == "bash" ? kBash : *shell == "zsh" ? kZsh : kFish);
    code = 0;
  });
}

}  // namespace volcomp::cli
