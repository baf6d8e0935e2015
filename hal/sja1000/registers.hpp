#pragma once
// Registers of the SJA1000 CAN controller in PeliCAN mode. Names and sections: data sheet SJA1000,
// Philips Semiconductors, 2000 Jan 04.

#include <cstdint>

namespace volcomp::hal::sja1000 {

// Section 6.4.1. Registers marked "reset" can be written in reset mode only.
enum Register : std::uint8_t {
  kMode = 0,
  kCommand = 1,  // reads as 0
  kStatus = 2,
  kInterrupt = 3,  // cleared by reading, all but the receive interrupt
  kInterruptEnable = 4,
  kBusTiming0 = 6,          // reset
  kBusTiming1 = 7,          // reset
  kOutputControl = 8,       // reset
  kErrorWarningLimit = 13,  // reset
  kReceiveErrors = 14,      // reset
  kTransmitErrors = 15,     // reset
  kAcceptanceCode = 16,     // reset; four bytes
  kAcceptanceMask = 20,     // reset; four bytes, 1 = does not matter
  kFrameInformation = 16,   // write: transmit buffer; read: oldest frame of the receive FIFO
  kIdentifier = 17,         // two bytes, the identifier in their upper eleven bits
  kData = 19,               // up to eight bytes
  kClockDivider = 31,
};

// Mode register, section 6.4.3.
inline constexpr std::uint8_t kOperateDualFilter = 0;
inline constexpr std::uint8_t kResetMode = 1U << 0U;

// Command register, section 6.4.4.
inline constexpr std::uint8_t kTransmissionRequest = 1U << 0U;
inline constexpr std::uint8_t kAbortTransmission = 1U << 1U;
inline constexpr std::uint8_t kReleaseReceiveBuffer = 1U << 2U;
inline constexpr std::uint8_t kClearDataOverrun = 1U << 3U;

// Status register, section 6.4.5.
inline constexpr std::uint8_t kReceiveBufferFull = 1U << 0U;
inline constexpr std::uint8_t kDataOverrun = 1U << 1U;
inline constexpr std::uint8_t kTransmitBufferReleased = 1U << 2U;
inline constexpr std::uint8_t kTransmissionComplete = 1U << 3U;
inline constexpr std::uint8_t kErrorStatus = 1U << 6U;  // an error counter is at the warning limit
inline constexpr std::uint8_t kBusOff = 1U << 7U;

// Interrupt and interrupt enable register, sections 6.4.6 and 6.4.7.
inline constexpr std::uint8_t kReceiveInterrupt = 1U << 0U;
inline constexpr std::uint8_t kTransmitInterrupt = 1U << 1U;
inline constexpr std::uint8_t kErrorWarningInterrupt = 1U << 2U;
inline constexpr std::uint8_t kDataOverrunInterrupt = 1U << 3U;
inline constexpr std::uint8_t kErrorPassiveInterrupt = 1U << 5U;

// Frame information, sections 6.4.13 and 6.4.14.
inline constexpr std::uint8_t kExtendedFrame = 1U << 7U;
inline constexpr std::uint8_t kRemoteFrame = 1U << 6U;
inline constexpr std::uint8_t kLengthCode = 0x0F;  // 9…15 stand for 8

// Clock divider, section 6.5.4.
inline constexpr std::uint8_t kPeliCan = 1U << 7U;

// The receive FIFO holds 64 bytes, 3 + data of every frame (section 6.4.14).
inline constexpr unsigned kMostFramesInFifo = 64U / 3U;
inline constexpr std::uint8_t kWarningLimit = 96;        // value after reset
inline constexpr std::uint8_t kErrorPassiveLimit = 127;  // beyond it: error passive

}  // namespace volcomp::hal::sja1000
