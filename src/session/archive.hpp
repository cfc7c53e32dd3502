#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::archive {

static_assert(std::endian::native == std::endian::little, "snapshots are written as the numbers lie in memory");

/// Appends values to bytes. Surfaces are numbered where they first appear, so that sharing is restored.
class Writer {
 public:
  static constexpr bool writing = true;

  void bytes(const void* from, std::size_t size) { out_.append(static_cast<const char*>(from), size); }
  void number(const double& x) { bytes(&x, sizeof x); }
  void count(const std::size_t& n) {
    const auto fixed = static_cast<std::uint64_t>(n);
    bytes(&fixed, sizeof fixed);
  }
  void integer(const int& x) {
    const auto fixed = static_cast<std::int32_t>(x);
    bytes(&fixed, sizeof fixed);
  }
  void flag(const bool& x) { out_.push_back(x ? '\1' : '\0'); }
  void text(const std::string& x) {
    count(x.size());
    out_ += x;
  }
  void numbers(const std::vector<double>& x) {
    count(x.size());
    bytes(x.data(), x.size() * sizeof(double));
  }
  void points(const Points& x) {
    count(static_cast<std::size_t>(x.rows()));
    bytes(x.data(), static_cast<std::size_t>(x.size()) * sizeof(double));
  }
  void surface(const std::shared_ptr<const Surface>& x) {
    const auto [at, fresh] = numbers_.try_emplace(x.get(), surfaces_.size());
    if (fresh) surfaces_.push_back(x);
    count(at->second);
  }

  [[nodiscard]] const std::string& out() const { return out_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const Surface>>& surfaces() const { return surfaces_; }
  /// Returns the bytes so far and starts afresh, but continues the numbering of surfaces.
  [[nodiscard]] std::string take() { return std::exchange(out_, {}); }

 private:
  std::string out_;
  std::vector<std::shared_ptr<const Surface>> surfaces_;
  std::unordered_map<const Surface*, std::size_t> numbers_;
};

/// Reads values from bytes. Invalid data makes it `bad` from there on: nothing is read outside the bytes.
class Reader {
 public:
  static constexpr bool writing = false;

  Reader(std::string_view bytes, const std::vector<std::shared_ptr<const Surface>>& surfaces)
      : rest_(bytes), surfaces_(surfaces) {}

  void bytes(void* to, std::size_t size) {
    if (size > rest_.size()) return fail();
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  void number(double& x) { bytes(&x, sizeof x); }
  void count(std::size_t& n) {
    std::uint64_t fixed = 0;
    bytes(&fixed, sizeof fixed);
    n = static_cast<std::size_t>(fixed);
  }
  void integer(int& x) {
    std::int32_t fixed = 0;
    bytes(&fixed, sizeof fixed);
    x = fixed;
  }
  void flag(bool& x) {
    char c = 0;
    bytes(&c, 1);
    x = c != 0;
  }
  void text(std::string& x) {
    x.resize(length(1));
    bytes(x.data(), x.size());
  }
  void numbers(std::vector<double>& x) {
    x.resize(length(sizeof(double)));
    bytes(x.data(), x.size() * sizeof(double));
  }
  void points(Points& x) {
    x.resize(static_cast<Eigen::Index>(length(3 * sizeof(double))), 3);
    bytes(x.data(), static_cast<std::size_t>(x.size()) * sizeof(double));
  }
  void surface(std::shared_ptr<const Surface>& x) {
    std::size_t k = 0;
    count(k);
    if (k >= surfaces_.size()) return fail();
    x = surfaces_[k];
  }

  /// A count of items of at least `size` bytes each; 0 if there cannot be that many.
  [[nodiscard]] std::size_t length(std::size_t size) {
    std::size_t n = 0;
    count(n);
    if (n <= rest_.size() / size) return n;
    fail();
    return 0;
  }
  void fail() {
    bad_ = true;
    rest_ = {};
  }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  const std::vector<std::shared_ptr<const Surface>>& surfaces_;
  bool bad_ = false;
};

}  // namespace knead::archive
