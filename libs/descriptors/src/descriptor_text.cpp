#include "descriptor_text.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <type_traits>

#include "descriptor_fields.hpp"
#include "text.hpp"

namespace shape3d::descriptors::detail {
namespace {

constexpr std::array<std::string_view, 9> kKinds{"hsh",      "csm", "d2",  "egi", "random",
                                                 "panorama", "sni", "sci", "sgi"};
constexpr std::size_t kSpherical = 6;  // place of the first kind of a spherical image

Parameters defaults(std::string_view kind) {
  if (kind == "hsh") return HshParameters{};
  if (kind == "csm") return CsmParameters{};
  if (kind == "d2") return D2Parameters{};
  if (kind == "egi") return EgiParameters{};
  if (kind == "random") return RandomParameters{};
  if (kind == "panorama") return PanoramaParameters{};
  SphericalParameters spherical;
  spherical.image = kind == "sni"   ? SphericalImageKind::sni
                    : kind == "sci" ? SphericalImageKind::sci
                                    : SphericalImageKind::sgi;
  return spherical;
}

// "a, b or c"
template <class Names>
std::string listed(const Names& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

[[noreturn]] void refuse_value(std::string_view key, std::string_view value,
                               const std::string& expected) {
  throw std::invalid_argument(std::string(key) + " is '" + std::string(value) + "', expected " +
                              expected);
}

// One overload for each type of parameter.
template <class Number>
std::enable_if_t<std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>> read(
    std::string_view key, std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    refuse_value(key, text,
                 std::is_floating_point_v<Number> ? "a number"
                 : std::is_unsigned_v<Number>     ? "a whole number from 0 to 2^64 - 1"
                                                  : "a whole number");
  }
}

void read(std::string_view key, std::string_view text, bool& value) {
  if (text != "yes" && text != "no") refuse_value(key, text, "yes or no");
  value = text == "yes";
}

template <class Enum>
std::enable_if_t<std::is_enum_v<Enum>> read(std::string_view key, std::string_view text,
                                            Enum& value) {
  const auto& names = EnumNames<Enum>::names;
  const auto place = std::find(names.begin(), names.end(), text);
  if (place == names.end()) refuse_value(key, text, listed(names));
  value = static_cast<Enum>(place - names.begin());
}

template <class Number>
std::enable_if_t<std::is_integral_v<Number> && !std::is_same_v<Number, bool>, std::string> print(
    Number value) {
  return std::to_string(value);
}

std::string print(double value) { return number(value); }

template <class Bool>
std::enable_if_t<std::is_same_v<Bool, bool>, std::string> print(Bool value) {
  return value ? "yes" : "no";
}

template <class Enum>
std::enable_if_t<std::is_enum_v<Enum>, std::string> print(Enum value) {
  return std::string(EnumNames<Enum>::names[static_cast<std::size_t>(value)]);
}

template <class Visitor>
void visit_all(Description& description, Visitor&& visit) {
  std::visit([&](auto& parameters) { visit_fields(parameters, visit); }, description.parameters);
  visit("align", description.align);
}

}  // namespace

std::string_view kind_of(const Parameters& parameters) {
  if (const auto* spherical = std::get_if<SphericalParameters>(&parameters)) {
    return kKinds[kSpherical + static_cast<std::size_t>(spherical->image)];
  }
  return kKinds[parameters.index()];
}

std::vector<std::pair<std::string, std::string>> fields_of(const Description& description) {
  std::vector<std::pair<std::string, std::string>> fields;
  Description copy = description;
  visit_all(copy,
            [&](const char* key, const auto& value) { fields.emplace_back(key, print(value)); });
  return fields;
}

Description parse_description(std::string_view spec) {
  const std::size_t colon = spec.find(':');
  const std::string_view kind = spec.substr(0, colon);
  if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
    throw std::invalid_argument("descriptor kind is '" + std::string(kind) + "', expected " +
                                listed(kKinds));
  }
  Description description{defaults(kind), Align::none};
  std::vector<std::string> keys;
  for (const auto& [key, value] : fields_of(description)) keys.push_back(key);

  std::string_view rest =
      colon == std::string_view::npos ? std::string_view{} : spec.substr(colon + 1);
  if (colon != std::string_view::npos && rest.empty()) {
    throw std::invalid_argument("descriptor '" + std::string(spec) +
                                "' ends after ':', expected key=value");
  }
  std::map<std::string, std::string_view, std::less<>> given;
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) {
      throw std::invalid_argument("descriptor part is '" + std::string(part) +
                                  "', expected key=value");
    }
    const std::string key(part.substr(0, equals));
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      throw std::invalid_argument("descriptor key is '" + key + "', expected " + listed(keys) +
                                  " for " + std::string(kind));
    }
    if (!given.emplace(key, part.substr(equals + 1)).second) {
      throw std::invalid_argument("descriptor key '" + key + "' occurs twice, expected once");
    }
    if (comma == std::string_view::npos) break;
    rest = rest.substr(comma + 1);
    if (rest.empty()) {
      throw std::invalid_argument("descriptor '" + std::string(spec) +
                                  "' ends after ',', expected key=value");
    }
  }
  visit_all(description, [&](const char* key, auto& value) {
    const auto place = given.find(key);
    if (place != given.end()) read(key, place->second, value);
  });
  return description;
}

}  // namespace shape3d::descriptors::detail
