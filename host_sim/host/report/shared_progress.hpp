#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "host_sim/host/report/progress.hpp"

namespace volcomp::host {

// The progress of work in parallel (host/io/parallel.hpp), from any thread: how much of all parts
// is done, so that it never goes back.
class SharedProgress {
 public:
  // `from`, `to`: what the parts together take of the whole, 0…1.
  SharedProgress(const Progress& progress, std::size_t parts, double from = 0.0, double to = 1.0)
      : progress_(progress), done_(parts), from_(from), to_(to) {}

  // `done` of a part: 0…1.
  void show(std::size_t part, double done, const std::string& what);

 private:
  const Progress& progress_;
  std::mutex mutex_;  // of all below, and of calls of `progress_`
  std::vector<double> done_;
  double from_;
  double to_;
};

}  // namespace volcomp::host
