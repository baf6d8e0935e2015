#pragma once
// What a drive in somebody's cabinet has, from its EDS: objects, where each may be mapped, what it
// holds after power-on, and the PDOs. A simulated drive with a profile has no object more.

#include <memory>
#include <string>
#include <vector>

#include "firmware/canopen/pdo.hpp"
#include "host_sim/host/bus/cia402_objects.hpp"
#include "host_sim/host/bus/device_files/eds_file.hpp"

namespace volcomp::sim {

class DriveProfile {
 public:
  // Throws UserError naming the file when it describes no drive: 1000h, 6040h or 6041h is missing.
  explicit DriveProfile(host::EdsFile eds);

  [[nodiscard]] canopen::Dictionary dictionary() const {
    return {{rows_.data(), rows_.size()}, host::cia402_dictionary().ranges};
  }
  // A simulated drive answers no remote request: its TPDOs have bit 30 of their COB-ID set.
  [[nodiscard]] std::vector<canopen::PdoParameters> pdos(canopen::PdoKind kind,
                                                         std::uint8_t node_id) const;
  // Placeholders, too.
  [[nodiscard]] bool may_map(canopen::PdoKind kind, canopen::ObjectId object) const {
    return eds_.may_map(kind, object);
  }

  // Values after power-on where the EDS gives them. The application area keeps what the axis
  // determines: positions, limits, the cycle.
  void fill_communication(host::Cia402Objects& objects, std::uint8_t node_id) const;
  void fill_application(host::Cia402Objects& objects, std::uint8_t node_id) const;

 private:
  void add_row(const host::EdsFile::Key& key, const host::EdsFileObject& object);
  void fill(host::Cia402Objects& objects, const canopen::Entry& row, std::uint8_t node_id) const;

  host::EdsFile eds_;
  std::vector<canopen::Entry> rows_;
  std::size_t foreign_ = 0;  // bytes of Cia402Objects::foreign in use
};

}  // namespace volcomp::sim
