#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace knead::cbor {

// The part of CBOR (RFC 8949) that snapshots consist of: integers, byte and text strings, arrays
// and maps of known length, false, true, null, undefined and doubles. Names that come again and
// again (of fields and choices) are written once: the k-th new one is a text, and the number k
// stands for it afterwards.

static_assert(std::endian::native == std::endian::little,
              "byte strings hold numbers as they lie in memory");

enum class Major : std::uint8_t { count, negative, bytes, text, array, map, tag, simple };
inline constexpr char no = '\xf4', yes = '\xf5', null = '\xf6', undefined = '\xf7', real = '\xfb';

class Writer {
 public:
  explicit Writer(std::string_view head) : out_(head) {}

  /// The beginning of an item: its kind with a count, a length or a value.
  void head(Major major, std::uint64_t n) {
    const auto kind = static_cast<unsigned>(major) << 5U;
    const int size = n < 24 ? 0 : n <= 0xff ? 1 : n <= 0xffff ? 2 : n <= 0xffffffff ? 4 : 8;
    const unsigned more = size == 0 ? static_cast<unsigned>(n)
                                    : 24U + static_cast<unsigned>(std::countr_zero(size + 0U));
    out_ += static_cast<char>(kind | more);
    big_endian(n, size);
  }
  void simple(char value) { out_ += value; }
  void integer(int x) {
    x < 0 ? head(Major::negative, static_cast<std::uint64_t>(-1 - std::int64_t{x}))
          : head(Major::count, static_cast<std::uint64_t>(x));
  }
  void number(double x) {
    out_ += real;
    big_endian(std::bit_cast<std::uint64_t>(x), 8);
  }
  void text(std::string_view x) {
    head(Major::text, x.size());
    out_ += x;
  }
  void bytes(const void* from, std::size_t size) {
    head(Major::bytes, size);
    out_.append(static_cast<const char*>(from), size);
  }
  /// A name that is there as long as the writer.
  void name(std::string_view x) {
    const auto [at, fresh] = names_.try_emplace(x.data(), names_.size());
    fresh ? text(x) : head(Major::count, at->second);
  }

  [[nodiscard]] std::string& out() { return out_; }

 private:
  void big_endian(std::uint64_t n, int size) {
    const std::uint64_t swapped = __builtin_bswap64(n);
    out_.append(reinterpret_cast<const char*>(&swapped) + 8 - size, static_cast<std::size_t>(size));
  }

  std::string out_;
  std::unordered_map<const void*, std::size_t> names_;
};

/// Reads what is expected next. Anything else makes it `bad` from there on: nothing is read outside
/// the bytes, and no length is believed that they do not have.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  /// The count, length or value of an item of this kind.
  std::uint64_t head(Major major) {
    const unsigned first = rest_.empty() ? 0 : static_cast<unsigned char>(rest_.front()),
                   more = first & 31U;
    if (rest_.empty() || first >> 5U != static_cast<unsigned>(major) || more > 27) return fail();
    rest_.remove_prefix(1);
    return more < 24 ? more : big_endian(std::size_t{1} << (more - 24U));
  }
  /// The number of items that follow, which take a byte or more each.
  std::size_t length(Major major) {
    const std::uint64_t n = head(major);
    return n <= rest_.size() ? static_cast<std::size_t>(n) : fail();
  }
  /// A count of at most so much.
  std::size_t count(std::size_t most) {
    const std::uint64_t n = head(Major::count);
    return n <= most ? static_cast<std::size_t>(n) : fail();
  }
  /// Whether the next item is this one, which then is read.
  bool takes(char value) {
    if (rest_.empty() || rest_.front() != value) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void flag(bool& x) {
    x = takes(yes);
    if (!x && !takes(no)) fail();
  }
  void integer(int& x) {
    const bool negative = is(Major::negative);
    const std::uint64_t n = head(negative ? Major::negative : Major::count);
    if (n > 0x7fffffff) fail();
    x = negative ? -1 - static_cast<int>(n & 0x7fffffff) : static_cast<int>(n & 0x7fffffff);
  }
  void number(double& x) {
    if (!takes(real)) fail();
    x = std::bit_cast<double>(big_endian(8));
  }
  std::string_view string(Major major) {
    const std::size_t size = length(major);
    const std::string_view x = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return x;
  }
  std::string_view name() {
    if (is(Major::text)) return names_.emplace_back(string(Major::text));
    const std::size_t k = count(names_.size());
    if (k < names_.size()) return names_[k];
    fail();
    return {};
  }

  [[nodiscard]] bool is(Major major) const {
    return !rest_.empty() &&
           static_cast<unsigned char>(rest_.front()) >> 5U == static_cast<unsigned>(major);
  }
  std::size_t fail() {
    bad_ = true;
    rest_ = {};
    return 0;
  }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::uint64_t big_endian(std::size_t size) {
    if (size > rest_.size()) return fail();
    std::uint64_t n = 0;
    std::memcpy(reinterpret_cast<char*>(&n) + 8 - size, rest_.data(), size);
    rest_.remove_prefix(size);
    return __builtin_bswap64(n);
  }

  std::string_view rest_;
  std::vector<std::string_view> names_;
  bool bad_ = false;
};

}  // namespace knead::cbor
