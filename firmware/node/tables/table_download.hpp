#pragma once
// Where a table image waits: downloaded, checked, folded, activated (2110h…2112h). One buffer: the
// active tables themselves live in the compensator, so a download that fails costs nothing.
//
// On a board all of this is the background's. What takes long is done in preemptible scopes, which
// read the image and write nothing but `tables_` and the spare half of the compensator.

#include <array>

#include "firmware/canopen/abort_code.hpp"
#include "firmware/node/node_objects.hpp"
#include "firmware/node/preemption.hpp"
#include "firmware/node/tables/node_compensator.hpp"

namespace volcomp::node {

// An image of kNodeAxes axes with every knot used: header, machine, axes (comp/tables/image.hpp).
inline constexpr std::size_t kImageCapacity =
    96 + 160 * kMaxBodies + kNodeAxes * (64 + 48 * kNodeKnots);

class TableDownload {
 public:
  // `running`: the compensator ticks, so the machine can no longer be exchanged. It may change in
  // every preemptible scope.
  TableDownload(NodeObjects& objects, NodeCompensator& compensator, const bool& running,
                Preemption* preemption)
      : objects_(objects), compensator_(compensator), running_(running), preemption_(preemption) {}

  // --- the DOMAIN object 2110h:01

  // Refuses out_of_memory, device_state (tables are being handed over).
  canopen::AbortCode begin(std::size_t announced, Span<std::uint8_t>& sink);
  void finish(std::size_t size);
  void abandon();
  // The staged image; no_data when there is no complete one.
  canopen::AbortCode read(Span<const std::uint8_t>& source) const;

  // --- 2111h

  // Each command includes those before it that are still missing. Refuses device_state (nothing
  // staged, or a download under way) and general (2112h says why).
  canopen::AbortCode command(TableCommand command);

  // --- expansion (node_thermal.cpp); only where kFollowsTemperature

  // Folds the active tables again once 2701h's temperatures make a difference.
  ThermalState follow();

  // The compensator found its active tables damaged, or went back to none.
  void lost_active();
  void reset();

  [[nodiscard]] TableState state() const { return static_cast<TableState>(objects_.table_state); }
  // The image behind the active tables, while it is still here; empty otherwise.
  [[nodiscard]] Span<const std::uint8_t> active_image() const;
  // Of the tables that were checked last.
  [[nodiscard]] const MachineDescription& machine_description() const {
    return tables_.chain.description();
  }
  // An image that comes from the store: as if it had been downloaded.
  [[nodiscard]] Span<std::uint8_t> buffer() { return {image_.data(), image_.size()}; }

 private:
  void enter(TableState state) { objects_.table_state = static_cast<std::uint8_t>(state); }
  canopen::AbortCode judge(const Status& status, TableState next);
  canopen::AbortCode validate();
  canopen::AbortCode arm();
  canopen::AbortCode activate();
  [[nodiscard]] Status check_use() const;
  [[nodiscard]] bool past_expiry() const;
  void settle();
  void grow();
  void note_growth();

  // --- what takes long
  [[nodiscard]] std::uint32_t name_of(Span<const std::uint8_t> image) const;
  Status check(Span<const std::uint8_t> image);
  [[nodiscard]] NodeMachine machine() const;
  Status stage(const RuntimeChain& chain);
  Status stage();

  NodeObjects& objects_;
  NodeCompensator& compensator_;
  const bool& running_;
  Preemption* preemption_;
  std::array<std::uint8_t, kImageCapacity> image_{};
  TablesView tables_{};  // of the image, since it was last checked
};

// Writes a refusal (or its absence) to 2112h:02…06.
void report(const Status& status, NodeObjects& objects);

}  // namespace volcomp::node
