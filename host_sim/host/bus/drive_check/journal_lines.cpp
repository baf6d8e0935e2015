#include "host_sim/host/bus/drive_check/journal_lines.hpp"

#include <charconv>

#include <fmt/format.h>

#include "comp/core/crc32.hpp"

namespace volcomp::host {
namespace journal_lines {
namespace {

constexpr std::string_view kFirst = "volcomp-drive-journal 1";
constexpr std::size_t kCrcDigits = 8;

std::uint32_t crc_of(std::string_view text) {
  return crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string line(std::string_view text) { return fmt::format("{} {:08x}\n", text, crc_of(text)); }

// A name that has spaces, or bytes that end a line, is one word all the same.
std::string as_word(std::string_view name) {
  std::string word;
  for (const char c : name) {
    const bool plain = c > ' ' && c <= '~' && c != '%';
    word += plain ? std::string(1, c) : fmt::format("%{:02x}", static_cast<unsigned char>(c));
  }
  return word;
}

std::string value_line(std::string_view what, canopen::ObjectId object,
                       const SdoChannel::Bytes& value) {
  std::string text = fmt::format("{} {:04x} {:02x} ", what, object.index, object.sub);
  for (const std::uint8_t byte : value)
    text += fmt::format("{:02x}", byte);
  return line(text);
}

}  // namespace

std::string head(const JournalOwner& owner) {
  const auto& id = owner.identity;
  return line(kFirst) + line("bus " + as_word(owner.bus)) +
         line(fmt::format("drive {} {:08x} {:08x} {:08x} {:08x}", owner.node, id[0], id[1], id[2],
                          id[3]));
}

std::string before(canopen::ObjectId object, const SdoChannel::Bytes& value) {
  return value_line("before", object, value);
}

std::string after(canopen::ObjectId object, const SdoChannel::Bytes& value) {
  return value_line("after", object, value);
}

bool may_be_one(std::string_view text) {
  const std::size_t common = std::min(text.size(), kFirst.size());
  return text.substr(0, common) == kFirst.substr(0, common);
}

namespace {

// The next whole line without its checksum and its end; nothing: there is none.
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at) {
  const std::size_t end = text.find('\n', at);
  if (end == std::string_view::npos || end - at < kCrcDigits + 1) return std::nullopt;
  const std::string_view content = text.substr(at, end - at - kCrcDigits - 1);
  if (text.substr(at, end + 1 - at) != line(content)) return std::nullopt;
  at = end + 1;
  return content;
}

// Words of a line, one after the other; the last may be empty. What is no such word makes it bad.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view word() {
    const std::size_t end = rest_.find(' ');
    const std::string_view one = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    return one;
  }
  std::uint32_t number(int base, std::uint32_t most) {
    const std::string_view one = word();
    std::uint32_t value = 0;
    const auto [stop, error] = std::from_chars(one.data(), one.data() + one.size(), value, base);
    if (error != std::errc() || stop != one.data() + one.size() || value > most) good_ = false;
    return value;
  }
  SdoChannel::Bytes bytes() {
    const std::string_view digits = word();
    SdoChannel::Bytes value;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
      value.push_back(static_cast<std::uint8_t>(Words(digits.substr(i, 2)).number(16, UINT8_MAX)));
    return value;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::string_view rest_;
  bool good_ = true;
};

std::string name_in(std::string_view word) {
  std::string name;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] != '%') {
      name += word[i];
      continue;
    }
    name += static_cast<char>(Words(word.substr(i + 1, 2)).number(16, UINT8_MAX));
    i += 2;
  }
  return name;
}

bool take_head(std::string_view text, std::size_t& at, JournalOwner& owner) {
  const auto first = next_line(text, at);
  const auto bus = first == kFirst ? next_line(text, at) : std::nullopt;
  const auto drive = bus ? next_line(text, at) : std::nullopt;
  if (!drive) return false;
  Words of_bus(*bus);
  Words of_drive(*drive);
  if (of_bus.word() != "bus" || of_drive.word() != "drive") return false;
  owner.bus = name_in(of_bus.word());
  owner.node = static_cast<std::uint8_t>(of_drive.number(10, 127));
  for (std::uint32_t& number : owner.identity)
    number = of_drive.number(16, UINT32_MAX);
  return of_drive.good() && owner.node > 0;
}

bool take_value(std::string_view line, std::vector<KeptObject>& objects) {
  Words words(line);
  const std::string_view what = words.word();
  canopen::ObjectId object;
  object.index = static_cast<std::uint16_t>(words.number(16, UINT16_MAX));
  object.sub = static_cast<std::uint8_t>(words.number(16, UINT8_MAX));
  SdoChannel::Bytes value = words.bytes();
  if (!words.good()) return false;
  if (what == "before") {
    objects.push_back({object, std::move(value), {}});
    return true;
  }
  for (KeptObject& kept : objects) {
    if (kept.object != object) continue;
    kept.written.push_back(std::move(value));
    return what == "after";
  }
  return false;
}

}  // namespace

std::size_t whole_bytes(std::string_view text) {
  std::size_t at = 0;
  while (next_line(text, at)) {
  }
  return at;
}

}  // namespace journal_lines

std::optional<JournalContent> read_journal(std::string_view text) {
  JournalContent content;
  std::size_t at = 0;
  if (!journal_lines::take_head(text, at, content.owner)) return std::nullopt;
  for (auto line = journal_lines::next_line(text, at); line;
       line = journal_lines::next_line(text, at)) {
    if (!journal_lines::take_value(*line, content.objects)) break;
  }
  return content;
}

}  // namespace volcomp::host
