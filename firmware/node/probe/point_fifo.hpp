#pragma once
// FIFO of points: never overwrites, counts drops.

#include <array>

#include "comp/core/span.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "firmware/node/probe/flank_probe.hpp"
#include "firmware/node/tables/node_compensator.hpp"

namespace volcomp::node {

// A point as 2410h hands it out, little-endian:
//
//    0  u32  sequence number          64  f32 × 3  standard uncertainty, nm, of the workpiece
//    4  u32  feature                               coordinates
//    8  u8   verdict (TouchVerdict)   76  u16      slot
//    9  u8   axis of the verdict      78  u16      zeros
//   10  u8   verdict on the flank     80  i64 × 5  positions of the axes as they were latched,
//   11  u8   verdict on the foot                   nm or 2^-40 turn
//   12  i8   side                    120  f64 × 5  their speeds, nm or 2^-40 turn per second
//   13  u8   row                     160  f64      distance λ from the flank, mm
//   14  u8   column                  168  f64 × 3  foot on the generated flank, gear frame, mm
//   15  u8   zero                    192  end
//   16  i64 × 3  machine, nm
//   40  i64 × 3  workpiece, nm
//
// Verdicts on flank and foot are Reasons (comp/probe/face_touch.hpp). Those of a point without
// flank are kNotJudged; slot, side, row, column, distance and foot are 0 then.
inline constexpr std::size_t kPointBytes = 192;
using PointRecord = std::array<std::uint8_t, kPointBytes>;

// A rejected touch has zeros instead of coordinates. `judged` with gear 0: no flank.
[[nodiscard]] PointRecord encode_point(const ProbePoint& point, const Touch& touch,
                                       const JudgedTouch& judged);

class PointFifo {
 public:
  static constexpr std::size_t kCapacity = 32;

  // False when full: the new point is not taken.
  bool push(const PointRecord& record);
  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  // Empty when nothing waits; valid until release() or clear().
  [[nodiscard]] Span<const std::uint8_t> oldest() const;
  // Makes room once the oldest point has been read. False when it has another number.
  bool release(std::uint32_t sequence);
  void clear() { first_ = waiting_ = 0; }

 private:
  std::array<PointRecord, kCapacity> record_{};
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
};

}  // namespace volcomp::node
