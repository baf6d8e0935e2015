#pragma once
// The smallest motion controller with volumetric compensation: a servo interrupt, encoder counters,
// and the XYFZ machine compiled in. A simulated machine turns the counters, so that it runs on any
// board and on a PC, with the same numbers to the last bit.
//
//   static ServoExample example;                 // in a function: no constructor runs before main
//   example.commission(table_image);             // once, in the background
//   timer interrupt at 5 kHz:   example.on_servo_interrupt();
//
// What a real controller changes: EncoderRegisters are those of its counters, SimulatedMachine is
// gone, and the settings are those of its machine.

#include <array>
#include <cstdint>

#include "comp/core/span.hpp"
#include "comp/tick/instances.hpp"
#include "firmware/embed/cpp/servo_loop.hpp"

namespace volcomp::example {

// On the boards in QEMU, where an instruction takes 64 ns, a period has 3125 of them: the tick that
// docs/evidence.md found to be the most expensive one, and what is around it here, fit in.
inline constexpr std::uint32_t kServo_Hz = 5'000;
inline constexpr std::size_t kAxes = XyfzCompensator::kAxes;

// As the hardware of a controller offers them: counters of the encoders, and what the position
// controllers add to their command.
struct EncoderRegisters {
  std::array<volatile std::int32_t, kAxes> count{};  // 10 nm each
  volatile std::uint32_t no_signal = 0;              // bit n: axis n
  std::array<volatile std::int32_t, kAxes> offset_nm{};
};

// The axis port of firmware/embed/cpp/axis_port.hpp over these registers.
class EncoderPort {
 public:
  static constexpr std::int64_t kNmPerCount = 10;

  explicit EncoderPort(EncoderRegisters& registers) : registers_(registers) {}
  void sample(XyfzCompensator::Input& in) noexcept;
  void apply(const XyfzCompensator::Output& out) noexcept;

 private:
  EncoderRegisters& registers_;
};

// Every axis runs to and fro between two ends at its own speed; once the signal of one of them
// fails for a while.
class SimulatedMachine {
 public:
  explicit SimulatedMachine(EncoderRegisters& registers) : registers_(registers) {}
  void advance();  // one servo period
  [[nodiscard]] std::uint32_t periods() const { return periods_; }

 private:
  EncoderRegisters& registers_;
  std::array<bool, kAxes> upwards_{};
  std::uint32_t periods_ = 0;
};

// The result, small enough to be compared by eye.
struct OffsetSummary {
  std::uint32_t periods = 0;
  std::array<std::int32_t, kAxes> least_nm{};
  std::array<std::int32_t, kAxes> largest_nm{};
  std::array<std::int32_t, kAxes> last_nm{};
  std::uint32_t fingerprint = 2166136261U;  // of every offset and status word (FNV-1a, by words)

  void add(const XyfzCompensator::Output& out);
};

class ServoExample {
 public:
  static constexpr std::uint32_t kPeriods = 8 * kServo_Hz;

  // Tables into the compensator, ramped in from the first period on. Refuses what check_image and
  // Compensator::stage refuse.
  Status commission(Span<const std::uint8_t> image);

  void on_servo_interrupt() {
    loop_.on_servo_interrupt();
    summary_.add(loop_.last_output());
  }
  [[nodiscard]] SimulatedMachine& machine() { return machine_; }
  [[nodiscard]] const OffsetSummary& summary() const { return summary_; }

 private:
  EncoderRegisters registers_;
  EncoderPort port_{registers_};
  SimulatedMachine machine_{registers_};
  XyfzCompensator compensator_;
  ServoLoop<XyfzCompensator, EncoderPort> loop_{compensator_, port_};
  OffsetSummary summary_;
};

// `console` has put(text), put_unsigned, put_decimal and put_hex, as hal/mps2/console.hpp.
template <class Console>
void tell(const OffsetSummary& summary, Console& console) {
  console.put("servo periods at 5 kHz    ");
  console.put_unsigned(summary.periods);
  for (std::size_t a = 0; a < kAxes; ++a) {
    constexpr std::array<const char*, kAxes> kNames = {"X", "Y", "Z"};
    console.put("\noffset ");
    console.put(kNames[a]);
    console.put(", nm: least ");
    console.put_decimal(summary.least_nm[a]);
    console.put(", largest ");
    console.put_decimal(summary.largest_nm[a]);
    console.put(", last ");
    console.put_decimal(summary.last_nm[a]);
  }
  console.put("\nfingerprint of all        ");
  console.put_hex(summary.fingerprint);
  console.put("\n");
}

}  // namespace volcomp::example
