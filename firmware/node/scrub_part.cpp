#include "firmware/node/scrub_part.hpp"

namespace volcomp::node {

using canopen::ErrorCode;

namespace {

// A bit that changes is seen at the end of the next whole pass: of the largest tables (128 knots,
// 64 KB) after 0.7 s, of 100 KB of code after 1.1 s.
constexpr std::uint64_t kPeriod_us = 1000;
constexpr std::size_t kBytes = 192;

}  // namespace

void ScrubPart::background(std::uint64_t now_us) {
  if (now_us < next_us_) return;
  next_us_ = now_us + kPeriod_us;
  for (std::size_t a = 0; a < kNodeAxes; ++a) {
    if (!core_.gate[a].check()) tables_.drop(ErrorCode::memory_damaged, a + 1);
  }
  Status status;
  if (!read_slices(status)) tables_.drop(ErrorCode::program_damaged, 0);
  if (status.ok()) return;
  report(status, core_.objects);
  const bool table = status.where.field == nullptr;
  tables_.drop(table ? ErrorCode::table_damaged : ErrorCode::memory_damaged, 0);
}

// Reads the next slices of what changes only by the background, and makes the tick drop tables that
// are damaged. No tick exchanges the sets meanwhile: only the background hands one over. False: the
// program is damaged.
bool ScrubPart::read_slices(Status& status) {
  const Preemptible preemptible(core_.preemption);
  status = core_.compensator.scrub(kBytes);
  return program_.step(kBytes);
}

}  // namespace volcomp::node
