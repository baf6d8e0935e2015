#include "host_sim/host/machine/chain_string.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace volcomp::host {
namespace {

constexpr const char* kAxisLetters = "XYZABCUVW";

bool is_axis(char c) { return std::string(kAxisLetters).find(c) != std::string::npos; }

// Primes as they are found in print become apostrophes.
std::string with_apostrophes(std::string text) {
  for (const std::string prime : {"\u2032", "\u2019"}) {
    for (std::size_t at = text.find(prime); at != std::string::npos; at = text.find(prime))
      text.replace(at, prime.size(), "'");
  }
  return text;
}

std::string without_brackets(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  const std::size_t last = text.find_last_not_of(' ');
  if (first == std::string::npos) return "";
  const std::string inner = text.substr(first, last - first + 1);
  const bool bracketed = inner.size() > 2 && inner.front() == '[' && inner.back() == ']';
  return bracketed ? inner.substr(1, inner.size() - 2) : inner;
}

std::string what_is(char c) {
  if (c == '(' || c == ')')
    return "a spindle in round brackets is no axis of the chain: leave it out";
  if (std::string("xyzacuv").find(c) != std::string::npos)
    return fmt::format("'{}' is not known: axes are capital letters", c);
  if (c == 'T' || c == 'F')
    return fmt::format("'{}' is not known: w, b and t stand for workpiece, bed and tool", c);
  return fmt::format(
      "'{}' is not known: a chain consists of w, b, t and the axes X Y Z A B C U V W", c);
}

// What is left of the text: letters, and where a prime stood.
struct Reading {
  std::string letters;
  std::string primed;  // axes with a prime
};

std::string read_letters(const std::string& text, Reading& out) {
  for (const char c : text) {
    if (c == '-' || c == ' ') continue;
    if (c == '\'') {
      if (out.letters.empty() || !is_axis(out.letters.back())) return "a prime follows no axis";
      out.primed += out.letters.back();
      continue;
    }
    if (!is_axis(c) && c != 'w' && c != 'b' && c != 't') return what_is(c);
    out.letters += c;
  }
  for (const char c : out.letters) {
    if (std::count(out.letters.begin(), out.letters.end(), c) == 1) continue;
    return fmt::format("'{}' appears more than once", c);
  }
  return "";
}

std::string check_primes(const Reading& r, const ChainLetters& chain) {
  if (r.primed.empty()) return "";
  for (const char c : chain.tool) {
    if (r.primed.find(c) != std::string::npos)
      return fmt::format("{} has a prime, but it is on the side of the tool", c);
  }
  for (const char c : chain.work) {
    if (r.primed.find(c) == std::string::npos)
      return fmt::format("{} has no prime, but it is on the side of the workpiece", c);
  }
  return "";
}

}  // namespace

std::string parse_chain(const std::string& text, ChainLetters& out) {
  Reading reading;
  if (std::string wrong = read_letters(without_brackets(with_apostrophes(text)), reading);
      !wrong.empty())
    return wrong;
  std::string letters = reading.letters;
  for (const char c : {'w', 'b', 't'}) {
    if (letters.find(c) != std::string::npos) continue;
    return fmt::format("'{}' is missing: w, b and t stand for workpiece, bed and tool", c);
  }
  if (letters.front() == 't') std::reverse(letters.begin(), letters.end());
  if (letters.front() != 'w' || letters.back() != 't')
    return "it must lead from w to t, or from t to w";
  const std::size_t bed = letters.find('b');
  ChainLetters chain{letters.substr(1, bed - 1), letters.substr(bed + 1)};
  chain.tool.pop_back();
  std::reverse(chain.work.begin(), chain.work.end());
  if (chain.work.empty() && chain.tool.empty()) return "it has no axis";
  if (std::string wrong = check_primes(reading, chain); !wrong.empty()) return wrong;
  out = chain;
  return "";
}

Axis axis_of_letter(char letter) {
  return static_cast<Axis>(std::string(kAxisLetters).find(letter) % 3);
}

bool is_rotary_letter(char letter) { return letter >= 'A' && letter <= 'C'; }

std::string chain_text(const MachineChain& chain) {
  const auto name = [&chain](std::uint8_t body) {
    const Joint& joint = chain.joint(body);
    return joint.moves() ? joint.letter : '.';
  };
  std::string letters = "b";
  for (const std::uint8_t body : chain.work())
    letters.insert(letters.begin(), name(body));
  for (const std::uint8_t body : chain.tool())
    letters += name(body);
  return fmt::format("w-{}-t", fmt::join(letters, "-"));
}

}  // namespace volcomp::host
