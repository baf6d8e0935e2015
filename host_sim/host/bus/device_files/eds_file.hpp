#pragma once
// Reads the electronic data sheet of somebody else's device (CiA 306-1), or a DCF: which objects it
// has, what may be done with each, and what it holds after power-on.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware/canopen/pdo.hpp"

namespace volcomp::host {

struct EdsFileObject {
  std::string name;
  std::uint16_t type = 0;  // CiA 301, table 44; DataType has those that a value here can have
  canopen::Access access = canopen::Access::read_only;
  bool to_rpdo = false;  // may be mapped into one
  bool to_tpdo = false;
  std::string value;  // DefaultValue, or ParameterValue of a DCF, as written; empty: none given
};

class EdsFile {
 public:
  static constexpr std::size_t kLargest = std::size_t{4} << 20U;

  // Throws UserError naming the file and what is wrong: a line that is no INI, no object at all. An
  // object whose section says nothing usable is left out.
  EdsFile(const std::string& text, const std::string& file);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& product() const { return product_; }

  // Objects by index and sub-index; of arrays and records their sub-indices only.
  using Key = std::pair<std::uint16_t, std::uint8_t>;
  [[nodiscard]] const std::map<Key, EdsFileObject>& objects() const { return objects_; }
  [[nodiscard]] const EdsFileObject* find(canopen::ObjectId object) const;
  // Whether a PDO of that kind takes the object; of types as indices (placeholders, an RPDO only)
  // by the section DummyUsage.
  [[nodiscard]] bool may_map(canopen::PdoKind kind, canopen::ObjectId object) const;
  // The value of an integer, "$NODEID" replaced; nothing when none is given, or something else (a
  // real number, a word): vendors write many things.
  [[nodiscard]] std::optional<std::uint64_t> number(canopen::ObjectId object,
                                                    std::uint8_t node_id) const;
  // The PDOs after power-on, the first eight; one that is missing between others is invalid. Where
  // the EDS tells no count of a mapping, as many entries as have a value.
  static constexpr std::size_t kMostPdos = 8;
  [[nodiscard]] std::vector<canopen::PdoParameters> pdos(canopen::PdoKind kind,
                                                         std::uint8_t node_id) const;

 private:
  using Section = std::map<std::string, std::string>;  // keys in lower case
  void take(const std::string& section, const Section& keys);
  void take_dummies(const Section& keys);
  [[nodiscard]] canopen::PdoParameters pdo(std::uint16_t communication, std::uint16_t mapping,
                                           std::uint8_t node_id) const;

  std::string file_;
  std::string product_;
  std::map<Key, EdsFileObject> objects_;
  std::set<std::uint16_t> dummies_;
};

// Throws UserError, also when it cannot be read.
[[nodiscard]] EdsFile read_eds_file(const std::string& path);

// Drives whose data sheets come with the program (host_sim/drives), in the order of the alphabet.
[[nodiscard]] std::vector<std::string> bundled_drives();
// The data sheet of one of them, or the file of that path. Throws UserError as read_eds_file(), and
// with the names there are for a name that is none.
[[nodiscard]] EdsFile find_drive_eds(const std::string& name_or_path);

}  // namespace volcomp::host
