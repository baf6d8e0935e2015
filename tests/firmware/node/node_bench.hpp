#pragma once
// A compensation node on a bench: three axes whose drives and controller are played by hand, one
// bus cycle at a time, and an SDO client. Drive units are nanometres.

#include <memory>
#include <string>
#include <vector>

#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::node {

using Bytes = std::vector<std::uint8_t>;

[[nodiscard]] Bytes image_of(const MachineTables& tables);
// Makes the CRCs of the axes and of the image right again after a field was tampered with; `tables`
// gives the lengths of the axes.
void reseal(Bytes& image, const MachineTables& tables);
// First byte of the block of an axis: q0 i64, pitch i64, knots u32, periodic u8 …
[[nodiscard]] std::size_t axis_at(const MachineTables& tables, std::size_t axis);

// Random tables of the XYFZ machine (docs/papers/xyfz.md), every offset below a few µm.
[[nodiscard]] MachineTables bench_tables(std::uint64_t seed = 0);

struct BenchEmergency {
  std::uint16_t code;
  std::uint8_t error_register;
  std::uint8_t source;
};

// What one drive sends and takes.
struct BenchDrive {
  std::int32_t target = -100'000'000;
  std::uint16_t status = 0x0127;  // operation enabled, referenced
  std::int32_t held = 0;          // 60B0h
  std::int32_t next = 0;          // arrived, in force from the next SYNC
  bool silent = false;            // neither the drive nor the controller speaks of this axis
};

constexpr std::uint8_t kBenchId = 32;

// What is written to 1010h and 1011h, in ASCII (CiA 301).
constexpr std::uint32_t kSave = 0x65766173;
constexpr std::uint32_t kLoad = 0x64616F6C;
constexpr std::size_t kBenchDrives = 3;

// The device of a bench, commissioned over SDO.
class BenchDevice {
 public:
  // The abort code, when the answer is there.
  virtual canopen::AbortCode write(canopen::ObjectId object, const Bytes& value) = 0;
  template <class T>
  canopen::AbortCode set(std::uint16_t index, std::uint8_t sub, T value) {
    Bytes bytes(sizeof(T));
    store_le(bytes.data(), sizeof(T), static_cast<std::uint64_t>(value));
    return write({index, sub}, bytes);
  }
  canopen::AbortCode command(TableCommand command) {
    return set(0x2111, 0, static_cast<std::uint8_t>(command));
  }
  // Downloads and activates.
  void load(const MachineTables& tables);

  // Since they were cleared.
  [[nodiscard]] bool emergency(canopen::ErrorCode code, std::uint8_t source) const;

  std::vector<BenchEmergency> emergencies;

 protected:
  BenchDevice() { client_.set_block_threshold(64); }
  ~BenchDevice() = default;

  // Cycle period, ramp, drives 1, 2, 3 for the axes.
  void configure(std::uint32_t period_us);
  // Notes emergencies, hands answers to the client.
  void hear(const hal::CanFrame& frame, std::uint64_t now_us);

  canopen::SdoClient client_;
};

[[nodiscard]] hal::CanFrame bench_frame(unsigned id, std::uint8_t size);

class NodeBench final : public BenchDevice {
 public:
  static constexpr std::uint8_t kId = kBenchId;
  static constexpr std::uint32_t kPeriod_us = 2000;
  static constexpr std::size_t kDrives = kBenchDrives;

  explicit NodeBench(Storage* storage = nullptr);

  void power_on();
  void give(const hal::CanFrame& frame);
  // Time passes in steps of 100 µs.
  void wait(std::uint64_t us);

  canopen::AbortCode write(canopen::ObjectId object, const Bytes& value) override;
  canopen::AbortCode read(canopen::ObjectId object, Bytes& value);
  // The value of an object that must be readable.
  std::uint64_t number(std::uint16_t index, std::uint8_t sub);
  std::string text(std::uint16_t index, std::uint8_t sub);

  // SYNC counter, cycle period, short ramp, drives.
  void configure();
  void nmt(canopen::NmtCommand command);
  // configure(), load(), start, until every offset has settled.
  void bring_up(const MachineTables& tables = bench_tables());

  // SYNC, then what drives and controller send, then the deadline.
  void cycle();
  void cycles(int count);
  // The steps of a cycle, for another order.
  void sync();
  void drive_data(std::size_t axis);
  void offset_report(std::size_t axis);
  void controller_data(std::size_t axis);

  [[nodiscard]] NodeState state() const { return static_cast<NodeState>(node->objects().state); }
  [[nodiscard]] std::uint16_t status(std::size_t axis) const {
    return node->objects().status[axis];
  }
  [[nodiscard]] std::array<std::int32_t, kDrives> offsets() const;

  std::unique_ptr<Node> node;
  std::array<BenchDrive, kDrives> drive;
  std::vector<hal::CanFrame> sent;  // since the last SYNC, without SDO
  std::uint64_t now_us = 0;
  std::int32_t largest_step = 0;  // of an offset a drive took in
  bool port_full = false;         // takes nothing that the node offers

 private:
  void drain();
  canopen::AbortCode finish();

  std::uint8_t counter_ = 0;
};

}  // namespace volcomp::node
