// volcomp completion, volcomp man

#include <memory>

#include <fmt/format.h>

#include "host_sim/cli/commands.hpp"
#include "host_sim/cli/completion.hpp"
#include "host_sim/cli/manual_page.hpp"

namespace volcomp::cli {

void add_completion_command(CLI::App& app, int& code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes the commands in a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "Whose: bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell, &code] {
    fmt::print("{}", completion_script(*shell));
    code = 0;
  });
}

void add_man_command(CLI::App& app, int& code) {
  CLI::App* command = app.add_subcommand("man", "Print the manual page (troff)");
  command->callback([&app, &code] {
    fmt::print("{}", manual_page(app));
    code = 0;
  });
}

}  // namespace volcomp::cli
