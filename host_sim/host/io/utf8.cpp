#include "host_sim/host/io/utf8.hpp"

#include <array>
#include <cstddef>

namespace volcomp::host {
namespace {

// The first byte gives the number of bytes that follow; only the first of those is restricted
// further.
struct Sequence {
  unsigned first_from, first_to;
  std::size_t following;
  unsigned second_from, second_to;
};

constexpr std::array<Sequence, 9> kSequences = {{{0x00, 0x7F, 0, 0, 0},
                                                 {0xC2, 0xDF, 1, 0x80, 0xBF},
                                                 {0xE0, 0xE0, 2, 0xA0, 0xBF},
                                                 {0xE1, 0xEC, 2, 0x80, 0xBF},
                                                 {0xED, 0xED, 2, 0x80, 0x9F},
                                                 {0xEE, 0xEF, 2, 0x80, 0xBF},
                                                 {0xF0, 0xF0, 3, 0x90, 0xBF},
                                                 {0xF1, 0xF3, 3, 0x80, 0xBF},
                                                 {0xF4, 0xF4, 3, 0x80, 0x8F}}};

unsigned byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

bool follows(std::string_view text, const Sequence& sequence) {
  if (text.size() <= sequence.following) return false;
  for (std::size_t i = 1; i <= sequence.following; ++i) {
    const unsigned from = i == 1 ? sequence.second_from : 0x80;
    const unsigned to = i == 1 ? sequence.second_to : 0xBF;
    if (byte_at(text, i) < from || byte_at(text, i) > to) return false;
  }
  return true;
}

// 0: none begins here.
std::size_t length_of_first(std::string_view text) {
  for (const Sequence& s : kSequences)
    if (byte_at(text, 0) >= s.first_from && byte_at(text, 0) <= s.first_to)
      return follows(text, s) ? s.following + 1 : 0;
  return 0;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = length_of_first(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace volcomp::host
