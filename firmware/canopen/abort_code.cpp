#include "firmware/canopen/abort_code.hpp"

#include <array>

namespace volcomp::canopen {
namespace {

struct Entry {
  AbortCode code;
  const char* sentence;
};

constexpr std::array<Entry, 28> kEntries{
    Entry{AbortCode::none, "The transfer succeeded."},
    Entry{AbortCode::toggle_bit, "A segment was lost or came twice: the toggle bit is wrong."},
    Entry{AbortCode::timeout, "The other side did not answer in time."},
    Entry{AbortCode::unknown_command,
          "The command is unknown, or does not belong to a transfer that is running."},
    Entry{AbortCode::block_size, "The block size is not between 1 and 127 segments."},
    Entry{AbortCode::block_sequence, "The sequence number of a block segment is impossible."},
    Entry{AbortCode::block_crc, "The checksum is wrong; the bytes were damaged on their way."},
    Entry{AbortCode::out_of_memory, "There is not enough memory for the transfer."},
    Entry{AbortCode::unsupported_access, "The object cannot be accessed in this way."},
    Entry{AbortCode::write_only, "The object can be written but not read."},
    Entry{AbortCode::read_only, "The object can be read but not written."},
    Entry{AbortCode::no_object, "There is no such object in the dictionary."},
    Entry{AbortCode::not_mappable, "The object cannot be mapped into this PDO."},
    Entry{AbortCode::mapping_too_long, "The mapped objects are longer than a PDO may be."},
    Entry{AbortCode::incompatible_parameter,
          "The parameter does not fit the other parameters of the device."},
    Entry{AbortCode::hardware, "The hardware reported an error during the access."},
    Entry{AbortCode::wrong_length, "The length does not match the type of the object."},
    Entry{AbortCode::too_long, "More bytes were sent than the object holds or were announced."},
    Entry{AbortCode::too_short, "Fewer bytes were sent than the object needs or were announced."},
    Entry{AbortCode::no_subindex, "The object has no such sub-index."},
    Entry{AbortCode::invalid_value, "The object cannot take this value."},
    Entry{AbortCode::value_too_high, "The value is above the allowed range."},
    Entry{AbortCode::value_too_low, "The value is below the allowed range."},
    Entry{AbortCode::general, "The device gave no particular reason."},
    Entry{AbortCode::cannot_store, "The data cannot be stored or handed to the application."},
    Entry{AbortCode::local_control,
          "The data cannot be stored because the device is controlled locally."},
    Entry{AbortCode::device_state, "The data cannot be stored in the present state of the device."},
    Entry{AbortCode::no_data, "There is no data to read."},
};

}  // namespace

const char* sentence(AbortCode code) {
  for (const Entry& entry : kEntries) {
    if (entry.code == code) return entry.sentence;
  }
  return "The device gave an abort code of its own.";
}

}  // namespace volcomp::canopen
