#pragma once
// Shared by the tests of the hardware layer: frames, and what a port has received.

#include <vector>

#include "hal/can_port.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {

inline hal::CanFrame frame(std::uint16_t id, const std::vector<std::uint8_t>& bytes = {}) {
  hal::CanFrame out;
  out.id = id;
  out.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), out.data.begin());
  return out;
}

// Half of the bytes 00h or FFh, so that long runs of equal bits occur.
inline hal::CanFrame random_frame(Random& random) {
  hal::CanFrame out;
  out.id = static_cast<std::uint16_t>(random.integer(0, hal::kMaxCanId));
  out.size = static_cast<std::uint8_t>(random.integer(0, 8));
  for (std::size_t i = 0; i < out.size; ++i) {
    const std::int64_t extreme = random.chance(0.5) ? 0x00 : 0xFF;
    out.data[i] =
        static_cast<std::uint8_t>(random.chance(0.5) ? extreme : random.integer(0x00, 0xFF));
  }
  return out;
}

template <class Port>
std::vector<hal::CanFrame> receive_all(Port& port) {
  std::vector<hal::CanFrame> frames;
  for (hal::CanFrame f; port.receive(f);)
    frames.push_back(f);
  return frames;
}

template <class Port>
std::vector<unsigned> received_ids(Port& port) {
  std::vector<unsigned> ids;
  for (const hal::CanFrame& f : receive_all(port))
    ids.push_back(f.id);
  return ids;
}

}  // namespace volcomp::test
