#include "firmware/boards/mps2/node_link.hpp"

#include <array>
#include <cstring>

#include "hal/mps2/semihosting.hpp"

namespace volcomp::boards {
namespace {

bool slcan_is_wanted() {
  std::array<char, 128> line{};
  if (!hal::mps2::semihosting::command_line(line)) return false;
  const char* const space = std::strrchr(line.data(), ' ');
  return space != nullptr && std::strcmp(space + 1, "slcan") == 0;
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
