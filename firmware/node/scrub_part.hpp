#pragma once
// The memory check of the node, a slice every millisecond: gates, tables, chain, settings, program.

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/program_check.hpp"
#include "firmware/node/tables/table_download.hpp"

namespace volcomp::node {

class ScrubPart : public NodePart {
 public:
  ScrubPart(NodeCore& core, TableDownload& tables) : core_(core), tables_(tables) {}

  // Code and constants that are checked, too; before power_on().
  void watch_program(Span<const std::uint8_t> program) { program_.watch(program); }
  void background(std::uint64_t now_us);
  [[nodiscard]] std::uint64_t rests_until_us() const { return next_us_; }

 private:
  bool read_slices(Status& status);

  NodeCore& core_;
  TableDownload& tables_;
  ProgramCheck program_{};
  std::uint64_t next_us_ = 0;
};

}  // namespace volcomp::node
