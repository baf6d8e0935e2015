#pragma once
// A machine measured before and after it was compensated: the same figures of both, what each is
// worth, and whether the difference means anything.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/intervals/interval.hpp"
#include "host_sim/host/measure/prediction.hpp"
#include "host_sim/host/measure/uncertainty.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/report/provenance.hpp"

namespace volcomp::host {

struct Figure {
  double um = 0.0;                         // as ISO 230-2 defines it, noise and all
  std::optional<FigureInterval> interval;  // of the true one, 95 %, µm
  // Expanded (k = 2), instrument and surroundings only: counts where there is no interval.
  std::optional<double> instrument_um;

  // What it is at most, for a verdict: the bound that 95 of 100 stay below.
  [[nodiscard]] double most_um() const {
    return interval ? interval->upper95 : um + instrument_um.value_or(0.0);
  }
};

enum class Change : std::uint8_t { better, worse, not_significant };

// One figure of one diagonal, or of all of them.
struct FigureComparison {
  std::string where;  // diagonal; "body diagonals", "face diagonals" (E_d, B_d), "volume"
  std::string name;   // "largest", "E", "B", "M", "A", "R", "E_d", "B_d", "max", "rms"
  Figure before;
  Figure after;
  Change change = Change::not_significant;
  bool decides = false;  // the verdict depends on it

  [[nodiscard]] double reduction_percent() const;  // of a `before` that is not zero
  // Else the figures are compared as they are.
  [[nodiscard]] bool by_statistics() const { return before.interval && after.interval; }
};

// Means of both directions by target, µm, relative to the first target.
struct DiagonalCurves {
  std::string name;
  std::vector<double> distance_mm;
  std::vector<double> before_um;
  std::vector<double> after_um;
  std::optional<PredictedDiagonal> predicted;
};

struct VerificationInput {
  DiagonalsFile before;
  DiagonalsFile after;
  std::optional<VolumeFile> volume_before;
  std::optional<VolumeFile> volume_after;
  UncertaintyStatement uncertainty;
  std::optional<double> limit_um;  // of E and of the largest error in the volume
  std::optional<TablesModel> tables;
  std::size_t draws = 4000;  // behind every interval
  std::uint64_t seed = 1;    // of the draws
};

struct VerificationResult {
  std::vector<FigureComparison> figures;
  std::vector<DiagonalCurves> curves;
  std::vector<Contribution> largest_contributions;  // to E of the diagonal that has the largest U
  std::vector<std::string> left_out;                // of the uncertainty
  std::vector<StatedValue> stated;                  // what the intervals take into account
  std::vector<std::string> remarks;
  std::size_t least_runs = 0;  // per direction
  bool ok = false;
  std::string verdict;
};

// Throws UserError when before and after are not of the same points, or the uncertainty is stated
// by half. E of all body diagonals together, of all face diagonals and the largest error in the
// volume decide. Ok: with a limit, the upper bound of each is within it; without, each is
// significantly smaller than before, and E of no diagonal is significantly larger. Significantly:
// the intervals do not touch; where there is none, by more than what instrument and surroundings
// add to both. The same for any number of processors.
[[nodiscard]] VerificationResult verify(const VerificationInput& input);

// --- verification_text.cpp: for people, for tables, for programs
// Verdict of the figures in `result`, and its words.
void judge(const VerificationInput& input, VerificationResult& result);
[[nodiscard]] std::string verification_text(const VerificationInput& input,
                                            const VerificationResult& result);
// The table of all figures, a section of a document: a row before, a row after.
[[nodiscard]] nlohmann::json verification_figures(const VerificationResult& result);
[[nodiscard]] std::string verification_csv(const VerificationResult& result);
[[nodiscard]] nlohmann::json verification_json(const VerificationInput& input,
                                               const VerificationResult& result);
// --- verification_report.cpp: a document of host_sim/host/report/page/README.md; `origins`: the
// files
[[nodiscard]] nlohmann::json verification_document(const VerificationInput& input,
                                                   const VerificationResult& result,
                                                   const RunContext& run, Origins origins);

}  // namespace volcomp::host
