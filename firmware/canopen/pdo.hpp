#pragma once
// Process data objects (CiA 301, sections 7.2.2 and 7.5.2.35–38): parameters that can be changed
// over SDO, mapping resolved to addresses once, frames copied at run time.

#include <array>
#include <cstdint>

#include "firmware/canopen/object_dictionary.hpp"
#include "hal/can_port.hpp"

namespace volcomp::canopen {

inline constexpr std::size_t kMostMapped = 8;
inline constexpr std::uint32_t kPdoInvalid = 1U << 31U;
inline constexpr std::uint32_t kPdoNoRtr = 1U << 30U;

// Transmission types (CiA 301, tables 67 and 72).
inline constexpr std::uint8_t kMostCyclicType = 240;  // 1…240: every n-th SYNC; 0: acyclic, at SYNC
inline constexpr std::uint8_t kEventType = 254;       // 254, 255: when the application says so

struct PdoParameters {
  std::uint32_t cob_id = kPdoInvalid;
  std::uint8_t type = kEventType;
  std::uint16_t inhibit_100us = 0;   // TPDO
  std::uint16_t event_timer_ms = 0;  // TPDO: sent at least so often; RPDO: not used
  std::uint8_t count = 0;
  std::array<std::uint32_t, kMostMapped> mapping{};
};

enum class PdoKind : std::uint8_t { receive, transmit };

// One PDO: its parameters and where its bytes come from or go to.
class Pdo {
 public:
  [[nodiscard]] const PdoParameters& parameters() const { return parameters_; }
  [[nodiscard]] bool valid() const { return (parameters_.cob_id & kPdoInvalid) == 0; }
  [[nodiscard]] std::uint16_t id() const {
    return static_cast<std::uint16_t>(parameters_.cob_id & hal::kMaxCanId);
  }
  [[nodiscard]] std::uint8_t bytes() const { return bytes_; }
  [[nodiscard]] bool synchronous() const { return parameters_.type <= kMostCyclicType; }
  // Valid, and with this identifier. One comparison: every frame asks every PDO.
  [[nodiscard]] bool answers_to(std::uint16_t frame_id) const { return frame_id == valid_id_; }

  // Replaces all parameters. Refuses no_object, not_mappable, mapping_too_long.
  AbortCode configure(const PdoParameters& parameters, PdoKind kind,
                      const ObjectDictionary& objects);
  void set_communication(const PdoParameters& parameters);

  // What its values mean to the application that receives them, a bit each (Dictionary::arrival).
  [[nodiscard]] std::uint32_t arrivals() const { return arrivals_; }

  void scatter(const hal::CanFrame& frame) const;  // frame.size ≥ bytes()
  void gather(hal::CanFrame& frame) const;

 private:
  // Where the mapped values are and how many bytes they have.
  struct Pieces {
    std::array<std::uint8_t*, kMostMapped> value{};  // nullptr: dummy, skipped
    std::array<std::uint8_t, kMostMapped> bytes{};
  };
  static constexpr std::uint16_t kNoFrame = 0xFFFF;

  std::uint16_t valid_id_ = kNoFrame;
  PdoParameters parameters_{};
  Pieces pieces_{};
  std::uint32_t arrivals_ = 0;
  std::uint8_t bytes_ = 0;
};

// How many of its first PDOs a device's cycle cannot do without: they are fixed in OPERATIONAL. The
// transmit PDOs among them go out when the application says so, and at no other time.
struct PdosOfCycle {
  std::size_t receive = 0;
  std::size_t transmit = 0;
};

// What 1400h, 1600h, 1800h and 1A00h and following say, read and written over SDO.
class PdoTable {
 public:
  PdoTable(Span<Pdo> receive, Span<Pdo> transmit, const PdosOfCycle& of_cycle,
           const ObjectDictionary& objects)
      : receive_(receive), transmit_(transmit), of_cycle_(of_cycle), objects_(objects) {}

  static constexpr std::uint16_t kReceiveCommunication = 0x1400;
  static constexpr std::uint16_t kReceiveMapping = 0x1600;
  static constexpr std::uint16_t kTransmitCommunication = 0x1800;
  static constexpr std::uint16_t kTransmitMapping = 0x1A00;
  [[nodiscard]] static bool owns(std::uint16_t index) { return index >= 0x1400 && index < 0x1C00; }

  struct Value {
    std::uint32_t value = 0;
    std::uint8_t bytes = 0;
  };
  AbortCode read(ObjectId object, Value& value) const;
  // How many bytes an object has; refuses read_only ones and what does not exist.
  AbortCode writable(ObjectId object, std::uint8_t& bytes) const;
  // The order CiA 301 prescribes: invalid, count 0, entries, count, valid.
  AbortCode write(ObjectId object, Span<const std::uint8_t> bytes, bool operational);

  [[nodiscard]] Span<Pdo> receive() const { return receive_; }
  [[nodiscard]] Span<Pdo> transmit() const { return transmit_; }

 private:
  struct Place {
    Pdo* pdo = nullptr;
    PdoKind kind = PdoKind::receive;
    bool mapping = false;
    bool of_cycle = false;
    [[nodiscard]] bool timed() const { return of_cycle && kind == PdoKind::transmit; }
  };
  [[nodiscard]] Place place(std::uint16_t index) const;
  static AbortCode write_communication(const Place& place, std::uint8_t sub, std::uint32_t value);
  AbortCode write_mapping(const Place& place, std::uint8_t sub, std::uint32_t value);
  static AbortCode write_cob_id(const Place& place, PdoParameters& p, std::uint32_t value);

  Span<Pdo> receive_;
  Span<Pdo> transmit_;
  PdosOfCycle of_cycle_;
  const ObjectDictionary& objects_;
};

}  // namespace volcomp::canopen
