#pragma once
// An EDS as a configuration tool reads it, and a powered-on node behind an SDO client. Nothing here
// knows the object dictionary of the code.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/canopen/sdo_client.hpp"
#include "firmware/node/node.hpp"

namespace volcomp::node::test {

using Section = std::map<std::string, std::string>;
using Ini = std::map<std::string, Section>;
using Bytes = std::vector<std::uint8_t>;

// A file of the project; empty when it cannot be read.
std::string project_file(const std::string& path);

inline constexpr const char* kRegenerate =
    "The file is not the one the code makes. Make it again:\n  build/host/host_sim/volcomp "
    "device-files --eds firmware/volcomp.eds --dbc firmware/volcomp.dbc";

Ini parse_ini(const std::string& text);

// One section that describes a value: an object without sub-indices, or a sub-index of one.
struct EdsEntry {
  canopen::ObjectId object;
  Section keys;

  [[nodiscard]] bool has(const std::string& key) const { return keys.count(key) != 0; }
  // A number in decimal or hexadecimal notation.
  [[nodiscard]] std::int64_t number(const std::string& key) const;
  [[nodiscard]] std::string access() const { return keys.at("AccessType"); }
  [[nodiscard]] bool is_string() const { return number("DataType") == 0x0009; }
  [[nodiscard]] bool is_domain() const { return number("DataType") == 0x000F; }
  [[nodiscard]] bool is_real() const {
    return number("DataType") == 0x0008 || number("DataType") == 0x0011;
  }
  // Bytes of a value of this type (CiA 301, table 44); 0: varies.
  [[nodiscard]] std::size_t bytes() const;
  // The default of a node with this id, as it goes over the bus.
  [[nodiscard]] std::optional<Bytes> default_value(std::uint8_t node_id) const;
};

std::vector<EdsEntry> entries_of(const Ini& eds);
std::string name_of(canopen::ObjectId object);
// Little-endian, two's complement.
Bytes little_endian(std::int64_t value, std::size_t size);

// There is a memory, and nothing in it.
class EmptyStorage final : public Storage {
 public:
  StoreResult save(Span<const std::uint8_t> /*parameters*/,
                   Span<const std::uint8_t> /*image*/) override {
    return StoreResult::done;
  }
  StoreResult load(Span<std::uint8_t>& /*parameters*/, Span<std::uint8_t>& /*image*/) override {
    return StoreResult::nothing_stored;
  }
  StoreResult erase() override { return StoreResult::done; }
};

// A device with everything a board has, as its EDS describes it. Frames in, frames out; time stands
// still.
class NodeOnTheBus {
 public:
  static constexpr std::uint8_t kId = 32;

  NodeOnTheBus();

  canopen::AbortCode read(canopen::ObjectId object, Bytes& value);
  canopen::AbortCode write(canopen::ObjectId object, const Bytes& value);
  // The number of a value that must be readable.
  std::uint32_t number(canopen::ObjectId object);
  [[nodiscard]] bool exists(canopen::ObjectId object);

 private:
  canopen::AbortCode finish();

  EmptyStorage storage_;
  std::unique_ptr<Node> node_ = std::make_unique<Node>(kId, &storage_);
  canopen::SdoClient client_;
};

}  // namespace volcomp::node::test
