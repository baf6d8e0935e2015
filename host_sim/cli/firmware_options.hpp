#pragma once
// --firmware and --firmware-image, the same for every command that has them.

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace volcomp::cli {

struct FirmwareChoice {
  std::string board;            // empty: none
  std::filesystem::path image;  // empty: that of the build

  [[nodiscard]] bool chosen() const { return !board.empty(); }
};

// `what`: beginning of the help text, `more`: further boards. The result is --firmware.
inline CLI::Option* add_firmware_options(CLI::App& command, FirmwareChoice& choice,
                                         const std::string& what, const std::string& more = {}) {
  CLI::Option* firmware = command.add_option(
      "--firmware", choice.board,
      what + " on a board that QEMU emulates: m7 (Cortex-M7), m4 (Cortex-M4F)" + more);
  command
      .add_option("--firmware-image", choice.image,
                  "Image of the node (default: build/BOARD/firmware/volcomp-node-BOARD.elf)")
      ->needs(firmware);
  return firmware;
}

}  // namespace volcomp::cli
