#include "host_sim/host/bus/can_log.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "host_sim/host/io/csv_cells.hpp"
#include "host_sim/host/io/input_file.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// Frames that two processors handled reach the socket in either order.
constexpr std::uint64_t kMostDisorder_us = 100'000;

using Text = std::string_view;

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

Content parse_words(const std::vector<Text>& words, LoggedFrame& logged) {
  if (words.size() < 3 || !parse_time(words[0], logged.time_us)) return Content::nonsense;
  return parse_frame(words[2], logged.frame);  // after the interface
}

}  // namespace

std::optional<LoggedFrame> parse_log_line(Text line, const std::string& name, std::size_t number) {
  const std::vector<Text> words = words_of(line);
  if (words.empty()) return std::nullopt;
  LoggedFrame logged;
  logged.line = number;
  const Content content = parse_words(words, logged);
  if (content == Content::nonsense)
    throw UserError(fmt::format("{}:{}: not a line of candump -L", name, number));
  if (content == Content::of_no_use) return std::nullopt;
  return logged;
}

std::uint64_t SteadyTime::of(const LoggedFrame& logged) {
  const std::uint64_t time_us = logged.time_us + set_back_us_;
  if (time_us + kMostDisorder_us < last_us_) set_back_us_ += last_us_ - time_us;
  last_us_ = std::max(last_us_, logged.time_us + set_back_us_);
  return last_us_;
}

namespace {

// Whether the frame there is older than the one before only because that came too early.
bool out_of_order(const std::vector<LoggedFrame>& log, std::size_t at, std::uint64_t set_back_us,
                  std::uint64_t last_us) {
  constexpr std::size_t kMostLate = 3;  // lines
  if (log[at].time_us + set_back_us + kMostDisorder_us < last_us) return false;
  const std::size_t end = std::min(at + 1 + kMostLate, log.size());
  for (std::size_t i = at + 1; i < end; ++i) {
    const std::uint64_t time_us = log[i].time_us + set_back_us;
    if (time_us >= last_us) return time_us - last_us <= kMostDisorder_us;
  }
  return end == log.size();
}

// Frames of one identifier come from one sender: they never change places.
void undo_clock_set(std::vector<LoggedFrame>& log) {
  std::map<std::uint16_t, std::uint64_t> last_of_id_us;
  std::uint64_t last_us = 0;
  std::uint64_t spacing_us = 0;
  std::uint64_t set_back_us = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    LoggedFrame& logged = log[i];
    std::uint64_t time_us = logged.time_us + set_back_us;
    std::uint64_t& own_us = last_of_id_us[logged.frame.id];
    const bool old = time_us < last_us;
    if (time_us < own_us || (old && !out_of_order(log, i, set_back_us, last_us))) {
      const std::uint64_t by_us = last_us + spacing_us - time_us;
      set_back_us += by_us;
      time_us += by_us;
      logged.clock_set_us = -static_cast<std::int64_t>(by_us);
    }
    logged.time_us = own_us = time_us;
    if (time_us < last_us) continue;
    if (i > 0) spacing_us = time_us - last_us;
    last_us = time_us;
  }
}

}  // namespace

std::vector<LoggedFrame> parse_can_log(Text text, const std::string& name) {
  std::vector<LoggedFrame> log;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::optional<LoggedFrame> parsed = parse_log_line(text.substr(0, end), name, number);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (parsed) log.push_back(*parsed);
  }
  if (log.empty()) throw UserError(fmt::format("{}: holds no frames", name));
  undo_clock_set(log);
  std::stable_sort(log.begin(), log.end(), [](const LoggedFrame& a, const LoggedFrame& b) {
    return a.time_us < b.time_us;
  });
  return log;
}

std::vector<LoggedFrame> read_can_log(const std::filesystem::path& path) {
  InputFile file(path);
  const std::string text((std::istreambuf_iterator<char>(file.stream())),
                         std::istreambuf_iterator<char>());
  return parse_can_log(text, file.name());
}

std::string log_line(std::uint64_t time_us, Text interface, const hal::CanFrame& frame) {
  std::string line = fmt::format("({:010}.{:06}) {} {:03X}#", time_us / 1'000'000U,
                                 time_us % 1'000'000U, interface, frame.id);
  for (std::size_t i = 0; i < frame.size; ++i)
    fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  return line;
}

CanLogWriter::CanLogWriter(const std::filesystem::path& path, std::string interface)
    : draft_(path), interface_(std::move(interface)) {
  if (draft_.is_beside()) interruption_.emplace();
}

void CanLogWriter::check() const {
  if (interruption_) interruption_->check();
}

void CanLogWriter::write(std::uint64_t time_us, const hal::CanFrame& frame) {
  check();
  draft_.write(log_line(time_us, interface_, frame) + '\n');
}

void CanLogWriter::finish() {
  check();
  draft_.complete();
  draft_.put_in_place();
  interruption_.reset();
}

}  // namespace volcomp::host
