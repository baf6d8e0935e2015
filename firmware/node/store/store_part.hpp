#pragma once
// Parameters and tables into the store and back: 1010h and 1011h (CiA 301, 7.5.2.13 and 7.5.2.14).

#include "firmware/node/node_core.hpp"
#include "firmware/node/node_part.hpp"
#include "firmware/node/store/storage.hpp"
#include "firmware/node/strokes/stroke_part.hpp"
#include "firmware/node/tables/table_download.hpp"

namespace volcomp::node {

// Room for all that is stored of the object dictionary, and for the learned tables.
inline constexpr std::size_t kParameterBytes =
    kWatchesStrokes ? 2560 + kMostLearnedBytes + kMostLearnedBytes / 32 : 2048;

class StorePart : public NodePart {
 public:
  // Without a storage 1010h and 1011h refuse.
  StorePart(NodeCore& core, TableDownload& tables, StrokePart& strokes, Storage* storage)
      : core_(core), tables_(tables), strokes_(strokes), storage_(storage) {}

  canopen::AbortCode before_write(canopen::ObjectId object, Span<const std::uint8_t> bytes) {
    if (object == object::store.id()) return save(bytes);
    return object == object::restore.id() ? restore(bytes) : canopen::AbortCode::none;
  }
  void before_read(canopen::ObjectId object);

  // The application area brings the tables along: validated, armed and active before the first
  // cycle. The other one: the communication area.
  void load(bool application);

 private:
  canopen::AbortCode save(Span<const std::uint8_t> signature);
  canopen::AbortCode restore(Span<const std::uint8_t> signature);
  StoreResult save_record(Span<const std::uint8_t> parameters, Span<const std::uint8_t> image);
  StoreResult erase_records();
  canopen::AbortCode report_result(StoreResult result);
  std::size_t collect_parameters();
  void apply_parameters(Span<const std::uint8_t> stored, bool application);
  void apply_pdo(std::uint16_t index, Span<const std::uint8_t> value);

  NodeCore& core_;
  TableDownload& tables_;
  StrokePart& strokes_;
  Storage* storage_;
  std::array<std::uint8_t, kParameterBytes> parameters_{};  // as stored
};

}  // namespace volcomp::node
