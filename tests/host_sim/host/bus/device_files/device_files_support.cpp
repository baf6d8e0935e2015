#include "tests/host_sim/host/bus/device_files/device_files_support.hpp"

#include <fstream>
#include <regex>
#include <sstream>

#include <fmt/format.h>

namespace volcomp::node::test {

using canopen::AbortCode;
using canopen::ObjectId;

// --- the file

std::string project_file(const std::string& path) {
  std::ifstream file(std::string(VOLCOMP_SOURCE_DIR) + "/" + path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  return content.str();
}

Ini parse_ini(const std::string& text) {
  Ini ini;
  std::string section;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == ';') continue;
    if (line.front() == '[') {
      section = line.substr(1, line.find(']') - 1);
      ini[section];
      continue;
    }
    const std::size_t equals = line.find('=');
    ini[section][line.substr(0, equals)] = line.substr(equals + 1);
  }
  return ini;
}

std::int64_t EdsEntry::number(const std::string& key) const {
  return std::stoll(keys.at(key), nullptr, 0);
}

std::size_t EdsEntry::bytes() const {
  switch (number("DataType")) {
    case 0x02:
    case 0x05:
      return 1;
    case 0x03:
    case 0x06:
      return 2;
    case 0x04:
    case 0x07:
    case 0x08:
      return 4;
    case 0x11:
    case 0x15:
    case 0x1B:
      return 8;
    default:
      return 0;
  }
}

Bytes little_endian(std::int64_t value, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
  return bytes;
}

std::optional<Bytes> EdsEntry::default_value(std::uint8_t node_id) const {
  if (!has("DefaultValue")) return std::nullopt;
  const std::string& text = keys.at("DefaultValue");
  if (is_string()) return Bytes(text.begin(), text.end());
  const std::string prefix = "$NODEID+";
  if (text.rfind(prefix, 0) == 0)
    return little_endian(std::stoll(text.substr(prefix.size()), nullptr, 0) + node_id, bytes());
  return little_endian(number("DefaultValue"), bytes());
}

std::vector<EdsEntry> entries_of(const Ini& eds) {
  const std::regex value("([0-9A-F]{4})(?:sub([0-9A-F]{1,2}))?");
  std::vector<EdsEntry> entries;
  for (const auto& [section, keys] : eds) {
    std::smatch match;
    if (!std::regex_match(section, match, value) || keys.count("SubNumber") != 0) continue;
    const unsigned long sub = match[2].matched ? std::stoul(match[2], nullptr, 16) : 0;
    const ObjectId object{static_cast<std::uint16_t>(std::stoul(match[1], nullptr, 16)),
                          static_cast<std::uint8_t>(sub)};
    entries.push_back({object, keys});
  }
  return entries;
}

std::string name_of(ObjectId object) {
  return fmt::format("{:04X}h:{:02X}", object.index, object.sub);
}

// --- the node

NodeOnTheBus::NodeOnTheBus() {
  node_->power_on(0);
  hal::CanFrame boot_up;
  while (node_->device().offer(boot_up, 0))
    node_->device().taken(0);
}

AbortCode NodeOnTheBus::finish() {
  constexpr int kMostFrames = 1000;
  for (int i = 0; i < kMostFrames && client_.state() == canopen::SdoClient::State::busy; ++i) {
    hal::CanFrame request{0x600 + kId, 8, {}};
    while (client_.request(request.data))
      node_->device().receive(request, 0);
    hal::CanFrame response;
    while (node_->device().offer(response, 0)) {
      node_->device().taken(0);
      if (response.id == 0x580 + kId) client_.response(response.data, 0);
    }
  }
  return client_.abort_code();
}

AbortCode NodeOnTheBus::read(ObjectId object, Bytes& value) {
  std::array<std::uint8_t, 256> sink{};
  client_.upload(object, sink, 0);
  const AbortCode why = finish();
  value.assign(sink.begin(), sink.begin() + static_cast<std::ptrdiff_t>(client_.transferred()));
  return why;
}

AbortCode NodeOnTheBus::write(ObjectId object, const Bytes& value) {
  client_.download(object, value, 0);
  return finish();
}

std::uint32_t NodeOnTheBus::number(ObjectId object) {
  Bytes value;
  const AbortCode why = read(object, value);
  if (why != AbortCode::none) throw std::runtime_error(name_of(object) + " cannot be read");
  std::uint32_t result = 0;
  for (std::size_t i = value.size(); i > 0; --i)
    result = result << 8U | value[i - 1];
  return result;
}

bool NodeOnTheBus::exists(ObjectId object) {
  Bytes value;
  const AbortCode why = read(object, value);
  return why != AbortCode::no_object && why != AbortCode::no_subindex;
}

}  // namespace volcomp::node::test
