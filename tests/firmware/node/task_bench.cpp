#include "tests/firmware/node/task_bench.hpp"

#include <algorithm>
#include <utility>

#include "comp/core/bytes.hpp"

namespace volcomp::node {
bool BenchPort::send(const hal::CanFrame& frame) {
  if (room == 0) return false;
  --room;
  out.push_back(frame);
  return true;
}

bool BenchPort::receive(hal::CanFrame& frame) {
  if (in.empty()) return false;
  frame = in.front();
  in.pop_front();
  return true;
}

void BenchSection::enter() {
  if (inside) ++misuses;
  inside = true;
  if (on_enter) on_enter();
}

void BenchSection::leave() {
  if (!inside) ++misuses;
  inside = false;
  if (on_leave) on_leave();
}

// --- bus

std::vector<hal::CanFrame> BenchBus::turn() {
  std::vector<hal::CanFrame> frames = std::exchange(extra_, {});
  sync_turn_ = !sync_turn_;
  if (!sync_turn_ || !with_sync) return frames;
  counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
  frames.push_back(bench_frame(canopen::kSync, 1));
  frames.back().data[0] = counter_;
  for (std::size_t a = 0; a < drive.size(); ++a) {
    BenchDrive& d = drive[a];
    largest_step = std::max(largest_step, std::abs(d.next - d.held));
    d.held = d.next;
    if (d.silent) continue;
    const auto id = static_cast<unsigned>(a) + 1U;
    hal::CanFrame actual = bench_frame(0x180U + id, 8);
    store_le(actual.data.data(), 4, static_cast<std::uint32_t>(d.target + d.held));
    store_le(&actual.data[4], 2, d.status);
    hal::CanFrame held = bench_frame(0x480U + id, 4);
    store_le(held.data.data(), 4, static_cast<std::uint32_t>(d.held));
    hal::CanFrame target = bench_frame(0x200U + id, 6);
    store_le(target.data.data(), 2, 0x0F);
    store_le(&target.data[2], 4, static_cast<std::uint32_t>(d.target));
    frames.insert(frames.end(), {actual, held, target});
  }
  return frames;
}

void BenchBus::nmt(canopen::NmtCommand command) {
  hal::CanFrame f = bench_frame(canopen::kNmt, 2);
  f.data[0] = static_cast<std::uint8_t>(command);
  f.data[1] = NodeBench::kId;
  put(f);
}

void BenchBus::hear(const hal::CanFrame& f) {
  const std::size_t axis = f.id - 0x301U;
  if (axis < drive.size()) drive[axis].next = static_cast<std::int32_t>(load_le(f.data.data(), 4));
}

// --- task

TaskBench::TaskBench(Storage* storage, const GuardianSettings& guardian, ResetCause cause)
    : task(std::make_unique<BenchTask>(Board{port, clock, section, watchdog}, kId, storage,
                                       guardian)) {
  task->power_on(cause);
}

void TaskBench::interrupt() {
  clock.us += turn_us;
  const Frames in = bus.turn();
  port.in.insert(port.in.end(), in.begin(), in.end());
  port.out.clear();
  task->on_timer_interrupt();
  sent = port.out;
  if (on_interrupt) on_interrupt(in, sent);
  for (const hal::CanFrame& f : sent) {
    bus.hear(f);
    hear(f, clock.us);
  }
}

void TaskBench::turn() {
  interrupt();
  if (background_hangs) return;
  if (background) return background();
  while (task->background_step()) {
  }
}

void TaskBench::turns(int count) {
  for (int i = 0; i < count; ++i)
    turn();
}

// --- SDO

canopen::AbortCode TaskBench::finish() {
  constexpr int kMostTurns = 10'000;
  canopen::SdoData request{};
  for (int i = 0; i < kMostTurns && client_.state() == canopen::SdoClient::State::busy; ++i) {
    while (client_.request(request))
      bus.put({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request});
    turn();
  }
  while (client_.request(request))
    bus.put({static_cast<std::uint16_t>(canopen::kSdoRequest + kId), 8, request});
  EXPECT_NE(client_.state(), canopen::SdoClient::State::busy);
  return client_.abort_code();
}

canopen::AbortCode TaskBench::write(canopen::ObjectId object, const Bytes& value) {
  client_.download(object, {value.data(), value.size()}, clock.us);
  return finish();
}

void TaskBench::configure() { BenchDevice::configure(2 * kTurn_us); }

void TaskBench::bring_up(const MachineTables& tables) {
  configure();
  load(tables);
  bus.nmt(canopen::NmtCommand::start);
  turns(150);
  ASSERT_EQ(state(), NodeState::compensating);
  emergencies.clear();
}

bool TaskBench::offsets_are_zero() const {
  return std::all_of(bus.drive.begin(), bus.drive.end(),
                     [](const BenchDrive& d) { return d.held == 0 && d.next == 0; });
}

}  // namespace volcomp::node
