#include "host_sim/cli/scenario_bus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware/canopen/cob_id.hpp"
#include "firmware/canopen/nmt.hpp"
#include "host_sim/host/bus/drive_model.hpp"

namespace volcomp::cli {

std::string describe(const NodePlace& place) {
  if (place.integrated()) return "integrated";
  if (place.firmware.chosen()) {
    const sim::EmulatedBoard& board = sim::emulated_board(place.firmware.board);
    return fmt::format("firmware on {} ({} in QEMU), {}{:g} Hz, lock step", board.processor,
                       board.machine, place.can.empty() ? "" : "CAN " + place.can + ", ",
                       place.cycle_hz);
  }
  const char* const how = place.can == "loopback" ? "node in this process" : "lock step";
  return fmt::format(
      "CAN {}, {:g} Hz, {}{}", place.can, place.cycle_hz, how,
      place.drives.empty() ? "" : fmt::format(", drives {}", fmt::join(place.drives, ",")));
}

std::size_t knots_at(const NodePlace& place) {
  return place.firmware.chosen() ? sim::emulated_board(place.firmware.board).knots : kDefaultKnots;
}

ScenarioBus::ScenarioBus(const NodePlace& place, sim::MachineWatch* watch)
    : cycle_hz_(place.cycle_hz), drives_(place.drives), watch_(watch) {
  for (const std::string& name : drives_)
    static_cast<void>(host::find_drive_model(name));
  join(place);
  if (place.log_file.empty()) return;
  const std::string name = place.firmware.chosen() ? place.firmware.board : place.can;
  // Without folder or device, so that two logs of the same run are the same file.
  log_ = std::make_unique<host::CanLogWriter>(place.log_file, name.substr(0, name.find(':')));
  const bool machine_time = link_ == nullptr || link_->turn_by_turn();
  recorder_ = std::make_unique<sim::BusRecorder>(
      *log_, machine_time ? sim::BusRecorder::Clock::machine : sim::BusRecorder::Clock::wall);
}

void ScenarioBus::join(const NodePlace& place) {
  if (place.firmware.chosen()) {
    board_ = std::make_unique<sim::EmulatedNode>(sim::emulated_board(place.firmware.board),
                                                 place.firmware.image, place.can);
    link_ = &board_->link();
  } else if (place.can != "loopback") {
    opened_ = host::open_frame_link(place.can);
    link_ = opened_.get();
  }
  if (link_ != nullptr) gateway_ = std::make_unique<sim::CanGateway>(*link_);
}

sim::BusAxesFactory ScenarioBus::axes() {
  sim::BusAxesFactory make = gateway_ ? sim::gateway_axes(*gateway_) : sim::loopback_axes();
  if (!drives_.empty()) make = sim::with_drives(std::move(make), drives_);
  if (recorder_) make = sim::recorded(std::move(make), *recorder_);
  return watch_ != nullptr ? sim::watched(std::move(make), *watch_) : make;
}

void ScenarioBus::switch_off() {
  if (link_ == nullptr) return;
  constexpr std::uint32_t kWait_us = 1000;
  constexpr int kPatience = 100;
  hal::CanFrame everybody{canopen::kNmt, 2, {}};
  everybody.data[0] = static_cast<std::uint8_t>(canopen::NmtCommand::enter_pre_operational);
  for (int i = 0; i < kPatience && !link_->send(everybody); ++i)
    link_->wait(kWait_us);
  link_->wait(kWait_us);
}

void ScenarioBus::finish() {
  if (log_) log_->finish();
  if (board_) board_->finish();
}

}  // namespace volcomp::cli
