#pragma once
// The facts of a ball bar's file (ball_bar_csv.hpp), lines "# key value".

#include <optional>
#include <string_view>
#include <vector>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/measure/ball_bar/ball_bar_circles.hpp"

namespace volcomp::host {

// How readings by number become angles, rad: by the step, or else by the angle of the last one.
struct Numbering {
  std::optional<double> start;
  std::optional<double> step;
  std::optional<double> end;
};

// 0: ccw, 1: cw. Fails at the current line for any other word.
[[nodiscard]] std::size_t circle_direction(const CsvLines& lines, std::string_view word);

class BallBarFacts {
 public:
  // Both must outlive it.
  BallBarFacts(const CsvLines& lines, BallBarTest& test) : lines_(lines), test_(test) {}

  // What stands behind a #; a comment is left alone. `late`: a reading was before it, and only what
  // belongs to a circle may follow.
  void read(std::string_view text, bool late);

  // Of the readings that follow.
  [[nodiscard]] long run() const { return run_; }
  [[nodiscard]] const std::optional<std::size_t>& direction() const { return direction_; }
  [[nodiscard]] const Numbering& numbering() const { return numbering_; }

 private:
  [[nodiscard]] double number(std::string_view word, std::string_view key) const;
  void take(std::string_view key, const std::vector<std::string_view>& words);
  void take_of_circle(std::string_view key, const std::vector<std::string_view>& words);
  [[nodiscard]] double positive(double step) const;
  [[nodiscard]] bool yes_or_no(std::string_view word) const;
  [[nodiscard]] long run_number(double value) const;

  const CsvLines& lines_;
  BallBarTest& test_;
  std::optional<std::size_t> direction_;
  Numbering numbering_;
  long run_ = 1;
};

}  // namespace volcomp::host
