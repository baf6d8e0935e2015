#pragma once
// A JSON value in fmt as what it is: fmt::format("{:.3f} {}", facts["offset"], facts["unit"]).

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

template <>
struct fmt::formatter<nlohmann::json> {
  constexpr auto parse(format_parse_context& context) {
    const auto* end = context.begin();
    while (end != context.end() && *end != '}')
      ++end;
    format_ = {context.begin(), static_cast<std::size_t>(end - context.begin())};
    return end;
  }

  template <class Context>
  auto format(const nlohmann::json& value, Context& context) const {
    const auto put = [&](const auto& plain) {
      return vformat_to(context.out(), "{:" + std::string(format_.begin(), format_.end()) + "}",
                        make_format_args(plain));
    };
    if (value.is_string()) return put(value.get_ref<const std::string&>());
    if (value.is_number_float()) return put(value.get<double>());
    if (value.is_number_unsigned()) return put(value.get<std::uint64_t>());
    if (value.is_number_integer()) return put(value.get<std::int64_t>());
    return put(value.dump());
  }

 private:
  string_view format_;
};
