#include "host_sim/host/bus/device_files/eds_file.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ini.h>

#include "host_sim/host/io/bundled_files.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/nearest_word.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

using Section = std::map<std::string, std::string>;
using Sections = std::map<std::string, Section>;

constexpr std::uint16_t kFirstObject = 0x1000;  // below are the data types

constexpr BundledFiles kDrives{"drives", ".eds", "VOLCOMP_DRIVES"};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

int keep(void* sections, const char* section, const char* key, const char* value) {
  (*static_cast<Sections*>(sections))[lower(section)][lower(key)] = value;
  return 1;
}

// Of the whole library, which has them as variables: an EDS has no continued lines, and a name in
// it may hold a semicolon.
void follow_cia306() {
  constexpr int kLongestLine = 1024;
  ini_allow_multiline = false;
  ini_allow_inline_comments = false;
  ini_use_stack = false;
  ini_max_line = kLongestLine;
}

Sections sections_of(const std::string& text, const std::string& file) {
  follow_cia306();
  Sections sections;
  const int line = ini_parse_string(text.c_str(), keep, &sections);
  if (line != 0)
    throw UserError(
        fmt::format("{}: line {} is neither a section nor a key with a value", file, line));
  return sections;
}

std::string value_of(const Section& keys, const char* key) {
  const auto found = keys.find(key);
  return found == keys.end() ? std::string() : found->second;
}

// Decimal, 0x… or, with a leading 0, octal: as CiA 306-1 writes numbers.
std::optional<std::uint64_t> number_in(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  const bool minus = !text.empty() && text[0] == '-';
  const std::size_t sign = minus ? 1 : 0;
  int base = 10;
  std::size_t begin = sign;
  if (text.size() > sign + 1 && text[sign] == '0') {
    const bool hexadecimal = text[sign + 1] == 'x' || text[sign + 1] == 'X';
    base = hexadecimal ? 16 : 8;
    begin += hexadecimal ? 2 : 1;
  }
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] =
      std::from_chars(text.data() + std::min(begin, text.size()), end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return minus ? ~value + 1 : value;
}

// "$NODEID+0x180" in any order.
std::optional<std::uint64_t> number_in(std::string text, std::uint8_t node_id) {
  const std::string name = "$nodeid";
  const std::size_t at = lower(text).find(name);
  if (at == std::string::npos) return number_in(text);
  text.erase(at, name.size());
  text.erase(std::remove(text.begin(), text.end(), '+'), text.end());
  if (text.find_first_not_of(' ') == std::string::npos) return node_id;
  const auto rest = number_in(text);
  return rest ? std::optional(*rest + node_id) : std::nullopt;
}

// "1A00", "1A00sub1".
std::optional<EdsFile::Key> key_of(const std::string& section) {
  const std::size_t sub = section.find("sub");
  const auto index = number_in("0x" + section.substr(0, sub));
  if (section.size() < 4 || !index || *index > UINT16_MAX) return std::nullopt;
  if (sub == std::string::npos) return EdsFile::Key{static_cast<std::uint16_t>(*index), 0};
  const auto number = number_in("0x" + section.substr(sub + 3));
  if (!number || *number > UINT8_MAX) return std::nullopt;
  return EdsFile::Key{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*number)};
}

// CiA 306-1, section 4.6.3: rww goes to process outputs of the device, rwr comes from its inputs.
void apply_access(EdsFileObject& object, const std::string& access, bool mappable) {
  using canopen::Access;
  const bool writes = access == "wo" || access.rfind("rw", 0) == 0;
  object.access = access == "const" ? Access::constant
                  : access == "wo"  ? Access::write_only
                  : writes          ? Access::read_write
                                    : Access::read_only;
  object.to_rpdo = mappable && writes && access != "rwr";
  object.to_tpdo = mappable && access != "wo" && access != "rww" && access != "const";
}

}  // namespace

EdsFile::EdsFile(const std::string& text, const std::string& file) : file_(file) {
  const Sections sections = sections_of(text, file);
  for (const auto& [name, keys] : sections)
    take(name, keys);
  if (objects_.empty()) throw UserError(fmt::format("{}: describes no object", file));
}

void EdsFile::take(const std::string& section, const Section& keys) {
  if (section == "deviceinfo") {
    product_ = value_of(keys, "productname");
  } else if (section == "dummyusage") {
    take_dummies(keys);
  } else if (const auto key = key_of(section)) {
    const std::string value = value_of(keys, "parametervalue");
    EdsFileObject object;
    object.name = value_of(keys, "parametername");
    object.value = value.empty() ? value_of(keys, "defaultvalue") : value;
    const auto type = number_in(value_of(keys, "datatype"));
    const bool typed = type && *type != 0 && *type <= UINT16_MAX;
    if (typed) object.type = static_cast<std::uint16_t>(*type);
    const auto mappable = number_in(value_of(keys, "pdomapping"));
    apply_access(object, lower(value_of(keys, "accesstype")), mappable.value_or(0) != 0);
    const std::uint64_t alike = number_in(value_of(keys, "compactsubobj")).value_or(0);
    if (alike > 0 && alike < UINT8_MAX && typed) {
      for (std::uint64_t sub = 1; sub <= alike; ++sub)
        objects_[{key->first, static_cast<std::uint8_t>(sub)}] = object;
    } else if (typed && keys.count("subnumber") == 0) {
      objects_[*key] = std::move(object);
    }
  }
}

// "Dummy0005=1".
void EdsFile::take_dummies(const Section& keys) {
  constexpr std::string_view kName = "dummy";
  for (const auto& [key, value] : keys) {
    if (key.rfind(kName, 0) != 0 || number_in(value).value_or(0) == 0) continue;
    const auto type = number_in("0x" + key.substr(kName.size()));
    if (type && *type <= UINT16_MAX) dummies_.insert(static_cast<std::uint16_t>(*type));
  }
}

bool EdsFile::may_map(canopen::PdoKind kind, canopen::ObjectId object) const {
  const bool received = kind == canopen::PdoKind::receive;
  if (object.index < kFirstObject) return received && dummies_.count(object.index) != 0;
  const EdsFileObject* const found = find(object);
  return found != nullptr && (received ? found->to_rpdo : found->to_tpdo);
}

const EdsFileObject* EdsFile::find(canopen::ObjectId object) const {
  const auto found = objects_.find({object.index, object.sub});
  return found == objects_.end() ? nullptr : &found->second;
}

std::optional<std::uint64_t> EdsFile::number(canopen::ObjectId object, std::uint8_t node_id) const {
  const EdsFileObject* const found = find(object);
  if (found == nullptr || found->value.empty()) return std::nullopt;
  return number_in(found->value, node_id);
}

canopen::PdoParameters EdsFile::pdo(std::uint16_t communication, std::uint16_t mapping,
                                    std::uint8_t node_id) const {
  const auto value = [&](std::uint16_t index, std::size_t sub) {
    return number({index, static_cast<std::uint8_t>(sub)}, node_id);
  };
  canopen::PdoParameters p;
  p.cob_id = static_cast<std::uint32_t>(value(communication, 1).value_or(canopen::kPdoInvalid));
  p.type = static_cast<std::uint8_t>(value(communication, 2).value_or(canopen::kEventType));
  p.inhibit_100us = static_cast<std::uint16_t>(value(communication, 3).value_or(0));
  p.event_timer_ms = static_cast<std::uint16_t>(value(communication, 5).value_or(0));
  const std::uint64_t most = value(mapping, 0).value_or(canopen::kMostMapped);
  for (std::size_t sub = 1; sub <= canopen::kMostMapped && sub <= most; ++sub) {
    const auto entry = value(mapping, sub);
    if (!entry || *entry == 0) break;
    p.mapping.at(p.count++) = static_cast<std::uint32_t>(*entry);
  }
  return p;
}

std::vector<canopen::PdoParameters> EdsFile::pdos(canopen::PdoKind kind,
                                                  std::uint8_t node_id) const {
  using canopen::PdoTable;
  const bool receive = kind == canopen::PdoKind::receive;
  const std::size_t communication =
      receive ? PdoTable::kReceiveCommunication : PdoTable::kTransmitCommunication;
  const std::size_t mapping = receive ? PdoTable::kReceiveMapping : PdoTable::kTransmitMapping;
  std::vector<canopen::PdoParameters> pdos;
  for (std::size_t n = 0; n < kMostPdos; ++n) {
    const auto index = static_cast<std::uint16_t>(communication + n);
    if (find({index, 1}) == nullptr) continue;
    pdos.resize(n + 1);
    pdos.back() = pdo(index, static_cast<std::uint16_t>(mapping + n), node_id);
  }
  return pdos;
}

EdsFile read_eds_file(const std::string& path) {
  InputFile input(path);
  const std::string text = input.beginning(EdsFile::kLargest + 1);
  if (text.size() > EdsFile::kLargest)
    throw UserError(fmt::format("{}: larger than 4 MiB, no EDS file", input.name()));
  return {text, input.name()};
}

std::vector<std::string> bundled_drives() { return names_of(kDrives); }

EdsFile find_drive_eds(const std::string& name_or_path) {
  const std::vector<std::string> names = bundled_drives();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return read_eds_file(path_of(kDrives, name_or_path).string());
  std::error_code ignored;
  const bool is_path = name_or_path == kStandardStream ||
                       name_or_path.find_first_of("./") != std::string::npos ||
                       std::filesystem::exists(name_or_path, ignored);
  if (!is_path) {
    const std::string near = nearest_word(name_or_path, names);
    throw UserError(fmt::format(
        "{}: no such drive{}; there are {}, or give the path of an EDS file", name_or_path,
        near.empty() ? "" : fmt::format(", did you mean '{}'?", near), fmt::join(names, ", ")));
  }
  return read_eds_file(name_or_path);
}

}  // namespace volcomp::host
