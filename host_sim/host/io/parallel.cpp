#include "host_sim/host/io/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "host_sim/host/io/interruption.hpp"

namespace volcomp::host {
namespace {

// What the threads share.
class Queue {
 public:
  Queue(std::size_t count, const std::function<void(std::size_t)>& work)
      : work_(work), failure_(count) {}

  void work_off() {
    for (std::size_t i = next_++; i < failure_.size() && !failed_; i = next_++) {
      try {
        work_(i);
      } catch (...) {
        failure_[i] = std::current_exception();
        failed_ = true;
      }
    }
  }

  void rethrow_first() const {
    for (const std::exception_ptr& failure : failure_)
      if (failure) std::rethrow_exception(failure);
  }

 private:
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::vector<std::exception_ptr> failure_;  // by index, each written by the thread that has it
};

// Joins in any case, and starts with signals blocked, which the threads inherit.
class Threads {
 public:
  ~Threads() {
    for (std::thread& thread : threads_)
      thread.join();
  }
  Threads() = default;
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  void start(std::size_t count, Queue& queue) {
    const SignalsHeld inherited;
    for (std::size_t i = 0; i < count; ++i)
      threads_.emplace_back([&queue] { queue.work_off(); });
  }

 private:
  std::vector<std::thread> threads_;
};

}  // namespace

std::size_t processors() { return std::max(1U, std::thread::hardware_concurrency()); }

void in_parallel(std::size_t count, std::size_t threads,
                 const std::function<void(std::size_t)>& work) {
  if (count == 0) return;
  Queue queue(count, work);
  {
    Threads more;
    more.start(std::clamp<std::size_t>(threads, 1, count) - 1, queue);
    queue.work_off();
  }
  queue.rethrow_first();
}

}  // namespace volcomp::host
