#include "firmware/node/store/storage.hpp"

namespace volcomp::node {

const char* sentence(StoreResult result) {
  switch (result) {
    case StoreResult::nothing_stored:
      return "Nothing is stored.";
    case StoreResult::loaded:
      return "The newest record was found intact.";
    case StoreResult::loaded_older:
      return "The last save was cut short or its record is damaged; the one before is used.";
    case StoreResult::damaged:
      return "What is stored is damaged and cannot be used.";
    case StoreResult::done:
      return "Done.";
    case StoreResult::too_large:
      return "The record does not fit a sector.";
    case StoreResult::buffer_too_small:
      return "The buffer is smaller than what is stored.";
    case StoreResult::read_failed:
      return "The memory reported a failure while reading.";
    case StoreResult::erase_failed:
      return "The memory reported a failure while erasing.";
    case StoreResult::write_failed:
      return "The memory reported a failure while writing.";
    case StoreResult::verify_failed:
      return "The memory does not hold what was written to it.";
    case StoreResult::read_only:
      return "The memory can only be read.";
  }
  return "Unknown result.";
}

}  // namespace volcomp::node
