#include "host_sim/cli/completion.hpp"

#include <fmt/format.h>

namespace volcomp::cli {
namespace {

// In single quotes a shell takes every character literally except the quote itself.
std::string quoted_for_shell(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c == '\n' ? ' ' : c;
    }
  }
  return quoted + "'";
}

// fish knows \' inside of quotes.
std::string quoted_for_fish(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "'";
}

std::vector<std::string> names_of(const std::vector<const CommandText*>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const CommandText* command : commands)
    names.push_back(quoted_for_shell(command->name));
  return names;
}

// The commands below another one: the words that lead on.
std::vector<std::string> places_below(const CommandText& program) {
  std::vector<std::string> names = names_of(all_commands(program));
  names.erase(names.begin());
  return names;
}

std::string last_word(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> words;
  for (const OptionText& o : command.options)
    words.insert(words.end(), o.names.begin(), o.names.end());
  return words;
}

// What can stand here beside options: commands, or the choices of an argument.
std::vector<std::string> plain_words(const CommandText& command) {
  std::vector<std::string> words;
  words.reserve(command.commands.size());
  for (const CommandText& below : command.commands)
    words.push_back(last_word(below.name));
  for (const OptionText& argument : command.arguments)
    words.insert(words.end(), argument.choices.begin(), argument.choices.end());
  return words;
}

// "'volcomp build-tables --model'|…" for the options whose value is of a kind.
template <class Wanted>
std::vector<std::string> places_of_values(const CommandText& program, const Wanted& wanted) {
  std::vector<std::string> places;
  for (const CommandText* command : all_commands(program)) {
    for (const OptionText& o : command->options) {
      if (!wanted(o)) continue;
      for (const std::string& name : o.names)
        places.push_back(quoted_for_shell(command->name + " " + name));
    }
  }
  return places;
}

// Cases of "$place $previous" for the options with choices; `line` makes what is done with them.
template <class Line>
std::string choice_cases(const CommandText& program, const char* open, const Line& line) {
  std::string text;
  for (const CommandText* command : all_commands(program)) {
    for (const OptionText& o : command->options) {
      if (o.value != ValueKind::choice) continue;
      std::vector<std::string> places;
      places.reserve(o.names.size());
      for (const std::string& name : o.names)
        places.push_back(quoted_for_shell(command->name + " " + name));
      text += fmt::format("    {}{}) {} ;;\n", open, fmt::join(places, "|"), line(o));
    }
  }
  return text;
}

bool is_number(const OptionText& o) { return o.value == ValueKind::number; }
bool is_text(const OptionText& o) { return o.value == ValueKind::text; }

}  // namespace

std::string bash_completion(const CommandText& program) {
  std::string text = fmt::format(
      "# bash completion of {0}; made by: {0} completion bash\n"
      "_{0}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  local place={0} offered= i\n"
      "  COMPREPLY=()\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"$place ${{COMP_WORDS[i]}}\" in\n"
      "    {1}) place+=\" ${{COMP_WORDS[i]}}\" ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$place $previous\" in\n",
      program.name, fmt::join(places_below(program), "|"));
  // Without an answer, readline completes the names of files: "-o default" below.
  text += choice_cases(program, "", [](const OptionText& o) {
    return fmt::format("mapfile -t COMPREPLY < <(compgen -W {} -- \"$current\"); return",
                       quoted_for_shell(fmt::format("{}", fmt::join(o.choices, " "))));
  });
  text += fmt::format("    {}) compopt +o default; return ;;\n    {}) return ;;\n  esac\n",
                      fmt::join(places_of_values(program, is_number), "|"),
                      fmt::join(places_of_values(program, is_text), "|"));
  text += "  case $place in\n";
  for (const CommandText* command : all_commands(program)) {
    text +=
        fmt::format("    {}) if [[ $current == -* ]]; then offered={}; else offered={}; fi ;;\n",
                    quoted_for_shell(command->name),
                    quoted_for_shell(fmt::format("{}", fmt::join(option_names(*command), " "))),
                    quoted_for_shell(fmt::format("{}", fmt::join(plain_words(*command), " "))));
  }
  return text + fmt::format(
                    "  esac\n"
                    "  mapfile -t COMPREPLY < <(compgen -W \"$offered\" -- \"$current\")\n"
                    "}}\n"
                    "complete -o default -F _{0} {0}\n",
                    program.name);
}

std::string zsh_completion(const CommandText& program) {
  // A colon ends the name in what _describe is given.
  const auto item = [](const std::string& name, const std::string& description) {
    return quoted_for_shell(name + ":" + description);
  };
  std::string text = fmt::format(
      "#compdef {0}\n"
      "# zsh completion of {0}; made by: {0} completion zsh\n"
      "_{0}() {{\n"
      "  local place={0} word\n"
      "  local -a offered options\n"
      "  for word in \"${{(@)words[2,CURRENT-1]}}\"; do\n"
      "    case \"$place $word\" in\n"
      "    ({1}) place+=\" $word\" ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$place ${{words[CURRENT-1]}}\" in\n",
      program.name, fmt::join(places_below(program), "|"));
  text += choice_cases(program, "(", [](const OptionText& o) {
    std::vector<std::string> choices;
    choices.reserve(o.choices.size());
    for (const std::string& choice : o.choices)
      choices.push_back(quoted_for_shell(choice));
    return fmt::format("compadd -- {}; return", fmt::join(choices, " "));
  });
  text +=
      fmt::format("    ({}) _message 'a number'; return ;;\n    ({}) _files; return ;;\n  esac\n",
                  fmt::join(places_of_values(program, is_number), "|"),
                  fmt::join(places_of_values(program, is_text), "|"));
  text += "  case $place in\n";
  for (const CommandText* command : all_commands(program)) {
    std::vector<std::string> options;
    for (const OptionText& o : command->options) {
      for (const std::string& name : o.names)
        options.push_back(item(name, o.description));
    }
    std::vector<std::string> offered;
    offered.reserve(command->commands.size());
    for (const CommandText& below : command->commands)
      offered.push_back(item(last_word(below.name), below.description));
    for (const OptionText& argument : command->arguments) {
      for (const std::string& choice : argument.choices)
        offered.push_back(item(choice, ""));
    }
    text += fmt::format("    ({})\n      options=({})\n      offered=({}) ;;\n",
                        quoted_for_shell(command->name), fmt::join(options, "\n        "),
                        fmt::join(offered, "\n        "));
  }
  return text + fmt::format(
                    "  esac\n"
                    "  if [[ $PREFIX == -* ]]; then\n"
                    "    _describe -o option options\n"
                    "  elif (( $#offered )); then\n"
                    "    _describe command offered\n"
                    "  else\n"
                    "    _files\n"
                    "  fi\n"
                    "}}\n"
                    "if [[ ${{funcstack[1]}} == _{0} ]]; then\n"
                    "  _{0} \"$@\"\n"
                    "else\n"
                    "  compdef _{0} {0}\n"
                    "fi\n",
                    program.name);
}

namespace {

// "-l json -s j -r -F -d '…'"
std::string fish_option(const OptionText& o) {
  std::string text;
  for (const std::string& name : o.names)
    text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
  switch (o.value) {
    case ValueKind::none:
      break;
    case ValueKind::choice:
      text +=
          fmt::format(" -x -a {}", quoted_for_fish(fmt::format("{}", fmt::join(o.choices, " "))));
      break;
    case ValueKind::number:
      text += " -x";
      break;
    case ValueKind::text:
      text += " -r -F";
      break;
  }
  return text + " -d " + quoted_for_fish(o.description);
}

}  // namespace

std::string fish_completion(const CommandText& program) {
  std::string text = fmt::format(
      "# fish completion of {0}; made by: {0} completion fish\n"
      "function __{0}_is_at\n"
      "    set -l place {0}\n"
      "    for word in (commandline -opc)[2..-1]\n"
      "        switch \"$place $word\"\n"
      "            case {1}\n"
      "                set place \"$place $word\"\n"
      "        end\n"
      "    end\n"
      "    test \"$place\" = \"$argv\"\n"
      "end\n",
      program.name, fmt::join(places_below(program), " "));
  for (const CommandText* command : all_commands(program)) {
    const std::string here =
        fmt::format("complete -c {} -n {}", program.name,
                    quoted_for_fish(fmt::format("__{}_is_at {}", program.name, command->name)));
    for (const CommandText& below : command->commands)
      text += fmt::format("{} -f -a {} -d {}\n", here, last_word(below.name),
                          quoted_for_fish(below.description));
    for (const OptionText& argument : command->arguments) {
      if (!argument.choices.empty())
        text += fmt::format("{} -f -a {}\n", here,
                            quoted_for_fish(fmt::format("{}", fmt::join(argument.choices, " "))));
    }
    for (const OptionText& o : command->options)
      text += here + fish_option(o) + "\n";
  }
  return text;
}

}  // namespace volcomp::cli
