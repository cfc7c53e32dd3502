#include "raw_numbers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "line_reader.hpp"

namespace knead::fields {

std::optional<RawNumber> raw_number_of(std::string_view name) {
  using enum RawNumber::Kind;
  struct Named {
    std::string_view name;
    RawNumber type;
  };
  static constexpr Named known[] = {
      {"float", {real, 4}},        {"float32", {real, 4}},   {"double", {real, 8}},
      {"float64", {real, 8}},      {"char", {whole, 1}},     {"int8", {whole, 1}},
      {"signed_char", {whole, 1}}, {"uchar", {natural, 1}},  {"uint8", {natural, 1}},
      {"short", {whole, 2}},       {"int16", {whole, 2}},    {"ushort", {natural, 2}},
      {"uint16", {natural, 2}},    {"int", {whole, 4}},      {"int32", {whole, 4}},
      {"uint", {natural, 4}},      {"uint32", {natural, 4}}, {"long", {whole, 8}},
      {"int64", {whole, 8}},       {"ulong", {natural, 8}},  {"uint64", {natural, 8}},
      {"vtkidtype", {whole, 8}}};
  std::string wanted = lower_case(name);
  for (const std::string_view prefix : {"vtktype", "unsigned_"}) {
    if (wanted.starts_with(prefix))
      wanted = (prefix == "unsigned_" ? "u" : "") + wanted.substr(prefix.size());
  }
  const auto found = std::ranges::find(known, wanted, &Named::name);
  if (found == std::end(known)) return std::nullopt;
  return found->type;
}

namespace {

template <class T>
double as_number(const std::array<char, 8>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return static_cast<double>(value);
}

}  // namespace

double read_raw(const char* bytes, const RawNumber& type, bool big_endian) {
  std::array<char, 8> own = {};
  std::memcpy(own.data(), bytes, type.bytes);
  if (big_endian != (std::endian::native == std::endian::big))
    std::reverse(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(type.bytes));
  if (type.kind == RawNumber::Kind::real)
    return type.bytes == 4 ? as_number<float>(own) : as_number<double>(own);
  const bool is_signed = type.kind == RawNumber::Kind::whole;
  switch (type.bytes) {
    case 1:
      return is_signed ? as_number<std::int8_t>(own) : as_number<std::uint8_t>(own);
    case 2:
      return is_signed ? as_number<std::int16_t>(own) : as_number<std::uint16_t>(own);
    case 4:
      return is_signed ? as_number<std::int32_t>(own) : as_number<std::uint32_t>(own);
    default:
      return is_signed ? as_number<std::int64_t>(own) : as_number<std::uint64_t>(own);
  }
}

static int value_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::optional<std::string> base64_decoded(std::string_view text, std::size_t most) {
  std::string result;
  std::uint32_t group = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (result.size() >= most) break;
    if (trimmed({&c, 1}).empty()) continue;
    const int value = value_of(c);
    if (value < 0 && c != '=') return std::nullopt;
    if (c == '=' ? digits < 2 : padding > 0) return std::nullopt;
    padding += c == '=' ? 1 : 0;
    group = group << 6U | static_cast<std::uint32_t>(c == '=' ? 0 : value);
    if (++digits < 4) continue;
    for (int k = 0; k < 3 - padding; ++k)
      result += static_cast<char>(group >> static_cast<unsigned>(16 - 8 * k) & 0xFFU);
    group = 0;
    digits = padding = 0;
  }
  if (result.size() > most) result.resize(most);
  return result;
}

}  // namespace knead::fields
