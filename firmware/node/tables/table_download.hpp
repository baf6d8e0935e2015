#pragma once
// Holds a table image while it is downloaded, checked, folded and activated (2110h…2112h). One
// buffer suffices: the active tables are in the compensator, so a failed download leaves them
// intact.
//
// On a board only the background calls it. Long work is done in preemptible scopes, which read the
// image and write only `tables_` and the spare half of the compensator.

#include <array>

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/probe/probe_part.hpp"

namespace volcomp::node {

// An image of kNodeAxes axes with every knot used: header, machine, axes (comp/tables/image.hpp).
inline constexpr std::size_t kImageCapacity =
    96 + 160 * kMaxBodies + kNodeAxes * (64 + 48 * kNodeKnots);

class TableDownload : public NodePart {
 public:
  TableDownload(NodeCore& core, ProbePart& probe) : core_(core), probe_(probe) {}

  // --- the contract of a part

  void reset();
  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
    if (object != object::table_command.id()) return canopen::AbortCode::none;
    return command(static_cast<TableCommand>(bytes[0]));
  }
  static bool owns_domain(canopen::ObjectId object) { return object == object::image.id(); }
  // The staged image; no_data when there is no complete one.
  canopen::AbortCode read_domain(canopen::ObjectId object, Span<const std::uint8_t>& source) const;
  // Refuses out_of_memory, device_state (tables are being handed over).
  canopen::AbortCode begin_domain(std::size_t announced, Span<std::uint8_t>& sink);
  canopen::AbortCode finish_domain(std::size_t size);
  void abandon_domain();

  // --- 2111h

  // Each command includes those before it that are still missing. Refuses device_state (nothing
  // staged, or a download under way) and general (2112h says why, and an emergency).
  canopen::AbortCode command(TableCommand command);
  // Offsets ramp to zero, until tables are activated again; the emergency names the cause.
  void drop(canopen::ErrorCode cause, std::size_t source);
  // Folds the active image again with these strains and hands it over. False, and nothing changes:
  // the buffer holds another image.
  bool fold_again(const Strains& strains);

  [[nodiscard]] TableState state() const {
    return static_cast<TableState>(core_.objects.table_state);
  }
  // The image of the active tables while the buffer still holds it; empty otherwise.
  [[nodiscard]] Span<const std::uint8_t> active_image() const;
  // The tables that were checked last.
  [[nodiscard]] const TablesView& checked() const { return tables_; }
  // Takes an image from the store as if it had been downloaded.
  [[nodiscard]] Span<std::uint8_t> buffer() { return {image_.data(), image_.size()}; }

 private:
  void enter(TableState state) { core_.objects.table_state = static_cast<std::uint8_t>(state); }
  canopen::AbortCode run(TableCommand command);
  canopen::AbortCode judge(const Status& status, TableState next);
  canopen::AbortCode validate();
  canopen::AbortCode arm();
  canopen::AbortCode activate();
  [[nodiscard]] Status check_use() const;
  void settle();
  void lost_active();

  // --- what takes long
  [[nodiscard]] std::uint32_t crc_of(Span<const std::uint8_t> image) const;
  Status check(Span<const std::uint8_t> image);
  [[nodiscard]] NodeMachine machine() const;
  Status stage(const RuntimeChain& chain);
  Status stage();

  NodeCore& core_;
  ProbePart& probe_;
  TablesView tables_{};  // of the image, since it was last checked
  std::array<std::uint8_t, kImageCapacity> image_{};
};

}  // namespace volcomp::node
