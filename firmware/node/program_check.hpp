#pragma once
// Code and constants of a board, checked a slice at a time: the checksum of the first pass after
// the start is what every later one is compared with.

#include <cstddef>
#include <cstdint>

#include "comp/core/crc32.hpp"
#include "comp/core/span.hpp"

namespace volcomp::node {

class ProgramCheck {
 public:
  // `program` stays readable. Nothing is checked where there is none.
  void watch(Span<const std::uint8_t> program) { *this = ProgramCheck(program); }
  ProgramCheck() = default;

  // The next `bytes`. False at the end of a pass that found another checksum than the first, and
  // ever after.
  bool step(std::size_t bytes) {
    if (!read_.read_on(program_, bytes)) return !damaged_;
    if (!known_) reference_ = read_.crc;
    known_ = true;
    damaged_ = damaged_ || read_.crc != reference_;
    return !damaged_;
  }

 private:
  explicit ProgramCheck(Span<const std::uint8_t> program) : program_(program) {}

  Span<const std::uint8_t> program_{};
  PiecewiseCrc read_;
  std::uint32_t reference_ = 0;
  bool known_ = false;  // the reference
  bool damaged_ = false;
};

}  // namespace volcomp::node
