#include "host_sim/bus_tools/can_log.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "host_sim/data/user_error.hpp"

namespace volcomp::sim {
namespace {

// Frames that two processors handled reach the socket in either order.
constexpr std::uint64_t kMostDisorder_us = 100'000;

using Text = std::string_view;

// The next word of a line; empty at its end.
Text take_word(Text& rest) {
  const std::size_t begin = std::min(rest.find_first_not_of(" \t\r"), rest.size());
  const std::size_t end = std::min(rest.find_first_of(" \t\r", begin), rest.size());
  const Text word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

template <class T>
bool parse_whole(Text digits, int base, T& value) {
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value, base);
  return error == std::errc() && stop == end;
}

// (seconds.microseconds)
bool parse_time(Text word, std::uint64_t& time_us) {
  constexpr std::size_t kDecimals = 6;
  constexpr std::uint64_t kMostSeconds = 1'000'000'000'000;
  if (word.size() < 2 || word.front() != '(' || word.back() != ')') return false;
  word = word.substr(1, word.size() - 2);
  const std::size_t point = word.find('.');
  if (point == Text::npos || word.size() - point - 1 != kDecimals) return false;
  std::uint64_t seconds = 0;
  std::uint64_t fraction = 0;
  if (!parse_whole(word.substr(0, point), 10, seconds) || seconds > kMostSeconds) return false;
  if (!parse_whole(word.substr(point + 1), 10, fraction)) return false;
  time_us = seconds * 1'000'000U + fraction;
  return true;
}

enum class Content : std::uint8_t { frame, of_no_use, nonsense };

// identifier#data: three hexadecimal digits for an 11-bit identifier, eight for 29 bits and error
// reports; R in place of the data for a remote request; ## for CAN FD.
Content parse_frame(Text word, hal::CanFrame& frame) {
  const std::size_t mark = word.find('#');
  if (mark != 3 && mark != 8) return Content::nonsense;
  std::uint32_t id = 0;
  if (!parse_whole(word.substr(0, mark), 16, id)) return Content::nonsense;
  const Text data = word.substr(mark + 1);
  if (mark == 8 || (!data.empty() && (data.front() == 'R' || data.front() == '#')))
    return Content::of_no_use;
  if (id > hal::kMaxCanId || data.size() % 2 != 0 || data.size() / 2 > frame.data.size())
    return Content::nonsense;
  frame.id = static_cast<std::uint16_t>(id);
  frame.size = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < frame.size; ++i) {
    if (!parse_whole(data.substr(2 * i, 2), 16, frame.data[i])) return Content::nonsense;
  }
  return Content::frame;
}

Content parse_line(Text line, LoggedFrame& logged) {
  const Text time = take_word(line);
  const Text interface = take_word(line);
  if (!parse_time(time, logged.time_us) || interface.empty()) return Content::nonsense;
  return parse_frame(take_word(line), logged.frame);
}

}  // namespace

std::vector<LoggedFrame> parse_can_log(Text text, const std::string& name) {
  std::vector<LoggedFrame> log;
  std::uint64_t last_us = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const Text line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.find_first_not_of(" \t\r") == Text::npos) continue;
    LoggedFrame logged;
    logged.line = number;
    const Content content = parse_line(line, logged);
    if (content == Content::nonsense)
      throw UserError(fmt::format("{}:{}: not a line of candump -L", name, number));
    if (content == Content::of_no_use) continue;
    if (logged.time_us + kMostDisorder_us < last_us)
      throw UserError(fmt::format("{}:{}: time runs backwards", name, number));
    last_us = std::max(last_us, logged.time_us);
    log.push_back(logged);
  }
  std::stable_sort(log.begin(), log.end(), [](const LoggedFrame& a, const LoggedFrame& b) {
    return a.time_us < b.time_us;
  });
  if (log.empty()) throw UserError(fmt::format("{}: holds no frames", name));
  return log;
}

std::vector<LoggedFrame> read_can_log(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const bool readable = stream.good() && !std::filesystem::is_directory(path);
  if (!readable) throw UserError(fmt::format("{}: cannot be opened", path.string()));
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  return parse_can_log(text, path.string());
}

std::string log_line(std::uint64_t time_us, Text interface, const hal::CanFrame& frame) {
  std::string line = fmt::format("({:010}.{:06}) {} {:03X}#", time_us / 1'000'000U,
                                 time_us % 1'000'000U, interface, frame.id);
  for (std::size_t i = 0; i < frame.size; ++i)
    fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  return line;
}

CanLogWriter::CanLogWriter(const std::filesystem::path& path, std::string interface)
    : path_(path), stream_(path, std::ios::binary), interface_(std::move(interface)) {
  if (!stream_) throw UserError(fmt::format("{}: cannot be written", path.string()));
}

void CanLogWriter::write(std::uint64_t time_us, const hal::CanFrame& frame) {
  stream_ << log_line(time_us, interface_, frame) << '\n';
  if (!stream_) throw UserError(fmt::format("{}: cannot be written", path_.string()));
}

void CanLogWriter::finish() {
  stream_.flush();
  if (!stream_) throw UserError(fmt::format("{}: cannot be written", path_.string()));
}

}  // namespace volcomp::sim
