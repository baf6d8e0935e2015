#pragma once
// Measured runs of one axis, made up by a test.

#include <memory>
#include <vector>

#include "comp/metrology/tables/table_builder.hpp"

namespace volcomp::test {

class Campaign {
 public:
  Campaign(Axis axis, std::vector<double> targets) : positions(std::move(targets)) {
    measured.letter = static_cast<char>('X' + static_cast<int>(axis));
    measured.axis = axis;
    measured.convention = Convention::relative;
    measured.sensed_at_zero = Vec3::Zero();
    measured.kappa = 0;
  }
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;

  // `reading(q)` at every target, in the order of the positions.
  template <class Reading>
  void add_up(const Reading& reading) {
    up.push_back(run(reading));
  }
  template <class Reading>
  void add_down(const Reading& reading) {
    down.push_back(run(reading));
  }

  Status build(BuiltTable& out) {
    const auto views = [](const std::vector<std::vector<ErrorMotion>>& runs) {
      std::vector<Run> spans;
      for (const auto& r : runs)
        spans.emplace_back(r.data(), r.size());
      return spans;
    };
    const std::vector<Run> up_views = views(up);
    const std::vector<Run> down_views = views(down);
    measured.positions = positions;
    measured.up = up_views;
    measured.down = down_views;
    return build_table(measured, out);
  }

  MeasuredAxis measured;
  std::vector<double> positions;
  std::vector<std::vector<ErrorMotion>> up;
  std::vector<std::vector<ErrorMotion>> down;

 private:
  template <class Reading>
  std::vector<ErrorMotion> run(const Reading& reading) const {
    std::vector<ErrorMotion> values;
    for (const double q : positions)
      values.push_back(reading(q));
    return values;
  }
};

inline std::vector<double> uniform_targets(double first, double pitch, int count) {
  std::vector<double> q;
  for (int i = 0; i < count; ++i)
    q.push_back(first + pitch * i);
  return q;
}

inline ErrorMotion no_error(double) { return ErrorMotion::Zero(); }

}  // namespace volcomp::test
