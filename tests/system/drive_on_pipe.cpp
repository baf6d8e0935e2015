// A simulated drive at the other end of a frame pipe, for tests of the command line: it outlives
// the commands that meet it, as a real one does.
//
//   drive_on_pipe PROFILE NODE FOLDER
//
// After every command it writes all it holds to FOLDER/state. While FOLDER/stall_after holds a
// number, it stands still at that SDO download of a command, makes FOLDER/stalled, and goes on when
// FOLDER/go is there or the command is gone. It ends with FOLDER/quit.

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "firmware/canopen/exchange.hpp"
#include "hal/linux/node_pipe.hpp"
#include "host_sim/sim/drives/cia402_drive.hpp"

namespace {

namespace fs = std::filesystem;
using namespace volcomp;

class DriveOnPipe {
 public:
  DriveOnPipe(const std::string& profile, int node, fs::path folder)
      : folder_(std::move(folder)), node_(node), drive_(settings(profile, node)) {
    drive_.power_on(0);
    constexpr std::array<std::uint8_t, 2> kHeartbeat_ms{100, 0};
    drive_.poll(0);
    static_cast<void>(drive_.device().write({0x1017, 0}, {kHeartbeat_ms.data(), 2}));
    tell_state();
  }

  void serve() {
    while (!fs::exists(folder_ / "quit"))
      session();
  }

 private:
  static sim::Cia402Drive::Settings settings(const std::string& profile, int node) {
    sim::Cia402Drive::Settings s;
    s.node_id = static_cast<std::uint8_t>(node);
    s.profile = std::make_shared<const sim::DriveProfile>(host::find_drive_eds(profile));
    return s;
  }

  // Until the command is gone. Its clock begins at 0, that of the drive goes on.
  void session() {
    hal::NodePipe pipe;
    if (!pipe.open(folder_.c_str()).ok()) std::exit(1);
    std::size_t downloads = 0;
    bool met = false;
    while (!pipe.ended() && !fs::exists(folder_ / "quit")) {
      if (!pipe.begin_turn(10'000)) continue;
      met = true;
      const std::uint64_t now_us = begin_us_ + pipe.now_us();
      last_us_ = now_us;
      hal::CanFrame frame;
      while (pipe.receive(frame)) {
        drive_.receive(frame, now_us);
        if (frame.id == 0x600 + node_ && frame.data[0] >> 5U == 1 && ++downloads == stall_after())
          stand_still();
      }
      drive_.poll(now_us);
      while (drive_.offer(frame, now_us) && pipe.send(frame))
        drive_.taken(now_us);
      pipe.end_turn();
    }
    // On a bus its answers would have gone out.
    hal::CanFrame late;
    while (drive_.offer(late, last_us_))
      drive_.taken(last_us_);
    begin_us_ = last_us_ + 1000;
    if (met) tell_state();
  }

  [[nodiscard]] std::size_t stall_after() const {
    std::size_t count = 0;
    std::ifstream(folder_ / "stall_after") >> count;
    return count;
  }

  void stand_still() const {
    std::ofstream(folder_ / "stalled") << "\n";
    while (!fs::exists(folder_ / "go"))
      ::usleep(2000);
    fs::remove(folder_ / "go");
  }

  void tell_state() {
    std::string text;
    const auto add = [&text](const canopen::PdoParameters& p) {
      text += std::to_string(p.cob_id) + " " + std::to_string(p.type) + " " +
              std::to_string(p.inhibit_100us) + " " + std::to_string(p.count);
      for (const std::uint32_t entry : p.mapping)
        text += " " + std::to_string(entry);
      text += "\n";
    };
    for (const canopen::Pdo& pdo : drive_.device().pdos().receive())
      add(pdo.parameters());
    for (const canopen::Pdo& pdo : drive_.device().pdos().transmit())
      add(pdo.parameters());
    text += std::to_string(drive_.objects().offset) + "\n";
    std::ofstream(folder_ / "state.tmp") << text;
    fs::rename(folder_ / "state.tmp", folder_ / "state");
    ++sessions_;
    std::ofstream(folder_ / "sessions.tmp") << sessions_ << "\n";
    fs::rename(folder_ / "sessions.tmp", folder_ / "sessions");
  }

  fs::path folder_;
  int node_;
  sim::Cia402Drive drive_;
  std::uint64_t begin_us_ = 0;
  std::uint64_t last_us_ = 0;
  int sessions_ = -1;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));  // a command that was killed
  try {
    DriveOnPipe(argv[1], std::atoi(argv[2]), argv[3]).serve();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "drive_on_pipe: %s\n", e.what());
    return 1;
  }
  return 0;
}
