#pragma once
// Where a table image waits: downloaded, checked, folded, activated (2110h…2112h). One buffer: the
// active tables themselves live in the compensator, so a download that fails costs nothing.

#include <array>

#include "comp/realtime/instances.hpp"
#include "firmware/canopen/abort_code.hpp"
#include "firmware/node/node_objects.hpp"

namespace volcomp::node {

// An image of kNodeAxes axes with every knot used: header, machine, axes (comp/tables/image.hpp).
inline constexpr std::size_t kImageCapacity =
    96 + 160 * kMaxBodies + kNodeAxes * (64 + 48 * kDefaultKnots);

class TableDownload {
 public:
  TableDownload(NodeObjects& objects, LoadedCompensator& compensator)
      : objects_(objects), compensator_(compensator) {}

  // --- the DOMAIN object 2110h:01

  // Refuses out_of_memory, device_state (tables are being handed over).
  canopen::AbortCode begin(std::size_t announced, Span<std::uint8_t>& sink);
  void finish(std::size_t size);
  void abandon();
  // The staged image; no_data when there is no complete one.
  canopen::AbortCode read(Span<const std::uint8_t>& source) const;

  // --- 2111h

  // `running`: the compensator ticks, so the machine can no longer be exchanged. Each command
  // includes those before it that are still missing. Refuses device_state (nothing staged, or a
  // download under way) and general (2112h says why).
  canopen::AbortCode command(TableCommand command, bool running);

  // The compensator found its active tables damaged, or went back to none.
  void lost_active();
  void reset();

  [[nodiscard]] TableState state() const { return static_cast<TableState>(objects_.table_state); }
  // The image behind the active tables, while it is still here; empty otherwise.
  [[nodiscard]] Span<const std::uint8_t> active_image() const;
  // An image that comes from the store: as if it had been downloaded.
  [[nodiscard]] Span<std::uint8_t> buffer() { return {image_.data(), image_.size()}; }

 private:
  void enter(TableState state) { objects_.table_state = static_cast<std::uint8_t>(state); }
  canopen::AbortCode judge(const Status& status, TableState next);
  canopen::AbortCode validate();
  Status adopt_machine();
  canopen::AbortCode arm(bool running);
  canopen::AbortCode activate(bool running);

  NodeObjects& objects_;
  LoadedCompensator& compensator_;
  std::array<std::uint8_t, kImageCapacity> image_{};
  TablesView tables_{};  // of the image, since it was last checked
};

// Writes a refusal (or its absence) to 2112h:02…06.
void report(const Status& status, NodeObjects& objects);

}  // namespace volcomp::node
