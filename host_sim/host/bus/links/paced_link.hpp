#pragma once
// A link that leaves the other end time between frames. A virtual interface has no bit rate: a
// burst arrives at once, while a CAN controller has room for a few frames and an emulated processor
// fetches them late.

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "host_sim/host/bus/links/frame_link.hpp"

namespace volcomp::host {

class PacedLink final : public FrameLink {
 public:
  // How far the other end has come, in whatever it works; never decreases. The controller takes in
  // one frame between two calls, if there is one. May throw UserError when it comes no further.
  using Progress = std::function<std::uint64_t()>;

  // `burst`: frames the other end has room for; `spacing`: progress from one burst to the next.
  PacedLink(std::unique_ptr<FrameLink> link, Progress progress, int burst, std::uint64_t spacing)
      : link_(std::move(link)), progress_(std::move(progress)), burst_(burst), spacing_(spacing) {}

  // After a burst it waits until the other end has had its time.
  [[nodiscard]] bool send(const hal::CanFrame& frame) override {
    if (sent_ == burst_) await_progress();
    if (!link_->send(frame)) return false;
    ++sent_;
    return true;
  }
  [[nodiscard]] bool receive(hal::CanFrame& frame) override { return link_->receive(frame); }
  void wait(std::uint32_t timeout_us) override { link_->wait(timeout_us); }
  [[nodiscard]] std::uint64_t now_us() const override { return link_->now_us(); }
  [[nodiscard]] bool turn_by_turn() const override { return link_->turn_by_turn(); }

 private:
  // The other end can fetch the frames of the burst only once its controller has them all.
  void await_progress() {
    for (int frame = 0; frame < sent_; ++frame)
      static_cast<void>(progress_());
    // What it reports may be from before it had them: only progress after a change counts.
    await(progress_() + 1U);
    await(progress_() + spacing_);
    sent_ = 0;
  }
  void await(std::uint64_t progress) const {
    while (progress_() < progress)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  std::unique_ptr<FrameLink> link_;
  Progress progress_;
  int burst_;
  std::uint64_t spacing_;
  int sent_ = 0;  // since it waited
};

}  // namespace volcomp::host
