#include "host_sim/host/bus/device_files/dbc.hpp"

#include <cmath>

#include <fmt/format.h>

#include "host_sim/host/bus/device_files/bus_messages.hpp"

namespace volcomp::host {
namespace {

std::string joined(const std::vector<std::string>& names, const char* separator) {
  return fmt::format("{}", fmt::join(names, separator));
}

// Everything that fits, in physical units.
std::string range_text(const BusSignal& s) {
  const double span = std::exp2(static_cast<double>(s.bits));
  const double low = s.is_signed ? -span / 2.0 : 0.0;
  return fmt::format("{}|{}", low * s.factor, (low + span - 1.0) * s.factor);
}

void write_message(std::string& out, const BusMessage& m) {
  out += fmt::format("BO_ {} {}: {} {}\n", m.id, m.name, m.size, m.sender);
  for (const BusSignal& s : m.signals) {
    out += fmt::format(" SG_ {} : {}|{}@1{} ({},0) [{}] \"{}\" {}\n", s.name, s.first_bit, s.bits,
                       s.is_signed ? '-' : '+', s.factor, range_text(s), s.unit,
                       joined(m.receivers, ","));
  }
  out += '\n';
}

void write_comments(std::string& out, const BusMessage& m) {
  out += fmt::format("CM_ BO_ {} \"{}.\";\n", m.id, m.comment);
  for (const BusSignal& s : m.signals)
    out += fmt::format("CM_ SG_ {} {} \"{}.\";\n", m.id, s.name, s.comment);
}

void write_values(std::string& out, const BusMessage& m) {
  for (const BusSignal& s : m.signals) {
    if (s.values.empty()) continue;
    out += fmt::format("VAL_ {} {}", m.id, s.name);
    for (const auto& [value, name] : s.values)
      out += fmt::format(" {} \"{}\"", value, name);
    out += " ;\n";
  }
}

}  // namespace

std::string make_dbc(const BusSettings& bus) {
  const std::vector<BusMessage> messages = bus_messages(bus);
  std::string out = "VERSION \"1\"\n\nNS_ :\n\nBS_:\n\n";
  out += fmt::format("BU_: {}\n\n", joined(bus_stations(bus), " "));
  for (const BusMessage& m : messages)
    write_message(out, m);
  out += "CM_ \"Bus of a machine with volcomp. Made by: volcomp device-files --dbc FILE.\";\n";
  for (const BusMessage& m : messages)
    write_comments(out, m);
  out += '\n';
  for (const BusMessage& m : messages)
    write_values(out, m);
  return out;
}

}  // namespace volcomp::host
