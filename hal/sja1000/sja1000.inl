// Members of Sja1000; included by hal/sja1000/sja1000.hpp only.
#pragma once

#include <algorithm>

namespace volcomp::hal {

namespace sja1000 {

// Dual filter, standard frames (section 6.4.15.2): identifier and first data byte do not matter,
// the RTR bit of both filters has to be 0.
inline constexpr std::uint8_t kEveryId = 0xFF;
inline constexpr std::uint8_t kEveryDataFrame = 0xEF;

inline constexpr std::uint8_t kInterrupts = kReceiveInterrupt | kTransmitInterrupt |
                                            kErrorWarningInterrupt | kDataOverrunInterrupt |
                                            kErrorPassiveInterrupt;

}  // namespace sja1000

// Between two commands the chip needs a clock of its own (section 6.4.4): the time of one read.
template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::command(std::uint8_t bits) const {
  write(sja1000::kCommand, bits);
  static_cast<void>(read(sja1000::kStatus));
}

template <class Registers, class InterruptLock>
bool Sja1000<Registers, InterruptLock>::enter_reset_mode() const {
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    write(sja1000::kMode, sja1000::kResetMode);
    if ((read(sja1000::kMode) & sja1000::kResetMode) != 0) return true;
  }
  return false;
}

// In reset mode.
template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::configure() const {
  using namespace sja1000;
  write(kClockDivider, static_cast<std::uint8_t>(settings_.clock_divider | kPeliCan));
  write(kBusTiming0, settings_.bus_timing_0);
  write(kBusTiming1, settings_.bus_timing_1);
  write(kOutputControl, settings_.output_control);
  write(kErrorWarningLimit, kWarningLimit);
  for (std::uint8_t i = 0; i < 4; ++i) {
    write(static_cast<std::uint8_t>(kAcceptanceCode + i), 0);
    write(static_cast<std::uint8_t>(kAcceptanceMask + i), i % 2 == 0 ? kEveryId : kEveryDataFrame);
  }
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::join_bus() {
  static_cast<void>(read(sja1000::kInterrupt));  // clears what was pending
  write(sja1000::kInterruptEnable, sja1000::kInterrupts);
  write(sja1000::kMode, sja1000::kOperateDualFilter);
  note_bus_state();
}

template <class Registers, class InterruptLock>
bool Sja1000<Registers, InterruptLock>::start(Registers registers,
                                              const Sja1000Settings& settings) {
  const InterruptLock lock;
  registers_ = registers;
  settings_ = settings;
  if (!enter_reset_mode()) return false;
  configure();
  const bool answers =
      read(sja1000::kClockDivider) == (settings.clock_divider | sja1000::kPeliCan) &&
      read(sja1000::kAcceptanceMask + 1) == sja1000::kEveryDataFrame;
  if (!answers) return false;
  write(sja1000::kReceiveErrors, 0);
  write(sja1000::kTransmitErrors, 0);
  join_bus();
  return true;
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::on_interrupt() {
  using namespace sja1000;
  const InterruptLock lock;
  const std::uint8_t what = read(kInterrupt);
  if ((what & (kErrorWarningInterrupt | kErrorPassiveInterrupt)) != 0) note_bus_state();
  if ((what & (kReceiveInterrupt | kDataOverrunInterrupt)) != 0) take_all();
  if ((what & kTransmitInterrupt) != 0) feed_transmitter();
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::take_all() {
  using namespace sja1000;
  for (unsigned i = 0; i < kMostFramesInFifo; ++i) {
    if ((read(kStatus) & kReceiveBufferFull) == 0) break;
    take_one();
    command(kReleaseReceiveBuffer);
  }
  if ((read(kStatus) & kDataOverrun) == 0) return;
  ++counters_.fifo_overruns;
  command(kClearDataOverrun);
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::take_one() {
  using namespace sja1000;
  const std::uint8_t information = read(kFrameInformation);
  if ((information & kExtendedFrame) != 0) {
    ++counters_.extended;
    return;
  }
  CanFrame frame;
  const unsigned id = (unsigned{read(kIdentifier)} << 8U) | read(kIdentifier + 1);
  frame.id = static_cast<std::uint16_t>(id >> 5U);
  frame.size = std::min<std::uint8_t>(information & kLengthCode, 8);
  for (std::uint8_t i = 0; i < frame.size; ++i)
    frame.data[i] = read(static_cast<std::uint8_t>(kData + i));
  ++(received_.push(frame) ? counters_.received : counters_.ring_overruns);
}

template <class Registers, class InterruptLock>
bool Sja1000<Registers, InterruptLock>::send(const CanFrame& frame) {
  const InterruptLock lock;
  const bool on_bus = state_ != CanBusState::off && state_ != CanBusState::stopped;
  if (!on_bus || !waiting_.push(frame)) {
    ++counters_.refused;
    return false;
  }
  feed_transmitter();
  return true;
}

// Checks the transmit buffer, from any caller and however often: a lost interrupt costs time only.
template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::feed_transmitter() {
  using namespace sja1000;
  const std::uint8_t status = read(kStatus);
  if ((status & kTransmitBufferReleased) == 0) {
    const bool too_late = waiting_.empty() || waiting_.front().id >= loaded_.id;
    if (too_late || taking_back_) return;
    taking_back_ = true;
    command(kAbortTransmission);
    return;
  }
  if (is_loaded_) unload((status & kTransmissionComplete) != 0);
  if (!waiting_.empty()) load(waiting_.pop());
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::unload(bool sent) {
  ++(sent ? counters_.sent : counters_.taken_back);
  if (!sent) waiting_.put_back(loaded_);
  is_loaded_ = false;
  taking_back_ = false;
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::load(const CanFrame& frame) {
  using namespace sja1000;
  write(kFrameInformation, frame.size);
  write(kIdentifier, static_cast<std::uint8_t>(frame.id >> 3U));
  write(kIdentifier + 1, static_cast<std::uint8_t>(frame.id << 5U));
  for (std::uint8_t i = 0; i < frame.size; ++i)
    write(static_cast<std::uint8_t>(kData + i), frame.data[i]);
  loaded_ = frame;
  is_loaded_ = true;
  command(kTransmissionRequest);
}

// In bus-off the chip is in reset mode until set otherwise, then silent until the bus has been
// quiet for long enough (section 6.4.5, note 1).
template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::note_bus_state() {
  using namespace sja1000;
  const std::uint8_t status = read(kStatus);
  if ((status & kBusOff) != 0 || (read(kMode) & kResetMode) != 0) {
    counters_.bus_offs += state_ != CanBusState::off ? 1U : 0U;
    state_ = CanBusState::off;
    waiting_.clear();
    is_loaded_ = false;
    taking_back_ = false;
    return;
  }
  const std::uint8_t errors = std::max(read(kReceiveErrors), read(kTransmitErrors));
  const bool warning = (status & kErrorStatus) != 0;
  state_ = warning ? CanBusState::warning : CanBusState::active;
  if (errors > kErrorPassiveLimit) state_ = CanBusState::passive;
}

template <class Registers, class InterruptLock>
void Sja1000<Registers, InterruptLock>::supervise(std::uint64_t now_us) {
  const InterruptLock lock;
  if (state_ == CanBusState::stopped) return;
  if ((read(sja1000::kMode) & sja1000::kResetMode) == 0) {
    in_reset_since_us_ = now_us;
    return;
  }
  note_bus_state();
  if (now_us - in_reset_since_us_ < kBusOffPause_us) return;
  configure();
  join_bus();
}

template <class Registers, class InterruptLock>
std::uint32_t Sja1000<Registers, InterruptLock>::take_losses() {
  const InterruptLock lock;
  const std::uint32_t told = losses_told_;
  losses_told_ = counters_.fifo_overruns + counters_.ring_overruns;
  return losses_told_ - told;
}

template <class Registers, class InterruptLock>
CanBusState Sja1000<Registers, InterruptLock>::state() const {
  const InterruptLock lock;
  return state_;
}

template <class Registers, class InterruptLock>
Sja1000Counters Sja1000<Registers, InterruptLock>::counters() const {
  const InterruptLock lock;
  return counters_;
}

}  // namespace volcomp::hal
