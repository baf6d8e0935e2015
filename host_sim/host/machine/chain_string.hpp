#pragma once
// The kinematic chain as a string: "w-X-Y-b-Z-t" is a machine whose bed b carries Y, which carries
// X with the workpiece w, and Z with the tool t.

#include <string>

#include "comp/machine/machine_chain.hpp"

namespace volcomp::host {

// Letters of the axes from the bed outwards.
struct ChainLetters {
  std::string work;
  std::string tool;
};

// Reads a chain from either end, with dashes, blanks or nothing between the letters, in square
// brackets or without; a prime may mark the axes that carry the workpiece, then all of them and no
// other. Returns what is wrong with it, empty if nothing is; `out` is then filled in.
[[nodiscard]] std::string parse_chain(const std::string& text, ChainLetters& out);

// The letter gives the direction along or about which an axis moves: X, A and U belong to X.
[[nodiscard]] Axis axis_of_letter(char letter);
[[nodiscard]] bool is_rotary_letter(char letter);  // A B C

// "w-X-Y-b-Z-t"; a body without a joint is a dot.
[[nodiscard]] std::string chain_text(const MachineChain& chain);

}  // namespace volcomp::host
