#include "host_sim/host/report/shared_progress.hpp"

#include <algorithm>
#include <numeric>

namespace volcomp::host {

void SharedProgress::show(std::size_t part, double done, const std::string& what) {
  const std::lock_guard lock(mutex_);
  done_.at(part) = std::max(done_[part], done);
  const double all = std::accumulate(done_.begin(), done_.end(), 0.0);
  progress_(from_ + (to_ - from_) * all / static_cast<double>(done_.size()), what);
}

}  // namespace volcomp::host
