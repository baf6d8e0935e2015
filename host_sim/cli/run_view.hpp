#pragma once
// Live view of a running scenario: the statistics for its report and, with --serve, a page in
// browsers of this computer.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "host_sim/host/io/interruption.hpp"
#include "host_sim/sim/live/live_feed.hpp"
#include "host_sim/sim/live/live_server.hpp"

namespace volcomp::cli {

inline constexpr std::uint16_t kLivePort = 8470;

struct LiveChoice {
  std::optional<std::uint16_t> port;  // none: no page; 0: any port that is free
  bool stay = false;                  // after the run, until Ctrl+C
};

class RunView final : public sim::MachineWatch {
 public:
  // Prints the address of the page to `words`. Throws UserError when its port cannot be had.
  RunView(const LiveChoice& choice, const std::string& command, const std::string& transport,
          std::FILE* words);

  // The observers throw Interrupted.
  [[nodiscard]] std::unique_ptr<sim::MachineObserver> enter() override;
  void progress(double done, const std::string& what);

  [[nodiscard]] const sim::TickStatistics& ticks() const { return feed_.ticks(); }

  // Returns when the open pages have read it, or with Ctrl+C where the page is to stay.
  void ended(const nlohmann::json& document);
  void failed(const std::string& why);

 private:
  void await_readers() const;
  void stay() const;

  LiveChoice choice_;
  std::FILE* words_;
  sim::LiveFeed feed_;
  host::Interruption interruption_;  // a run removes its temporary folder and informs its page
  std::unique_ptr<sim::LiveServer> server_;
};

}  // namespace volcomp::cli
