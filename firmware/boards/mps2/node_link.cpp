#include "firmware/boards/mps2/node_link.hpp"

#include <array>
#include <string_view>
#include "hal/mps2/semihosting.hpp"

namespace volcomp::boards {
namespace {

bool slcan_is_wanted() {
  constexpr std::string_view kWord = " slcan";
  std::array<char, 128> text{};
  if (!hal::mps2::semihosting::command_line(text)) return false;
  std::string_view line(text.data());
  if (line.size() < kWord.size()) return false;
  line.remove_prefix(line.size() - kWord.size());
  return line == kWord;
}

}  // namespace

bool NodeLink::open() {
  hal::mps2::Clock::start();
  is_pipe_ = !slcan_is_wanted();
  if (is_pipe_) return pipe_.open();
  slcan_.start();
  return true;
}

}  // namespace volcomp::boards
