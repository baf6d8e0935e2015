#pragma once
// Describes the strokes that a node of a helical grinder watches and what it has learned from them
// (firmware/node/strokes/stroke_objects.hpp).

#include <array>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "comp/core/status.hpp"
#include "comp/strokes/learning_guard.hpp"
#include "firmware/node/strokes/stroke_objects.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// The last step of one table.
struct LearnedTableDiagnosis {
  GuardAction action{};
  LearningResult result{};
  std::uint16_t updated = 0;  // nodes
  std::uint16_t clamped = 0;
  std::uint16_t skipped = 0;
  double flank_rms_um = 0.0;  // before
  double weight = 0.0;        // 0: no step yet
};

struct StrokeDiagnosis {
  bool on = false;
  std::array<std::uint32_t, kFrameUses> frames{};  // by FrameUse
  std::uint32_t passes_lost = 0;
  std::uint32_t discarded = 0;
  std::array<std::uint32_t, 2> passes{};  // since the last step, forward and backward
  std::array<double, 2> sync_rms_um{};    // of them, on the flank
  std::array<double, 2> x_rms_um{};
  Reason learning = Reason::ok;           // last refusal
  std::array<double, 3> prediction_um{};  // on the flank: lag of Z, of C, of both
  node::StrokeTableState tables{};
  double table_feed_mm_per_s = 0.0;
  std::uint16_t offset_status = 0;  // StatusBit, kOtherFeed
  double offset_urad = 0.0;
  std::array<LearnedTableDiagnosis, node::kStrokeTables> table{};  // forward, backward, slots
};

// Nothing for a node that does not know strokes. Throws as NodeClient::read.
[[nodiscard]] std::optional<StrokeDiagnosis> diagnose_strokes(NodeClient& client);

// "" when strokes are off.
[[nodiscard]] std::string describe(const StrokeDiagnosis& diagnosis);
[[nodiscard]] nlohmann::json to_json(const StrokeDiagnosis& diagnosis);

}  // namespace volcomp::host
