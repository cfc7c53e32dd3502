#include "parts.hpp"

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <limits>

#include "file.hpp"

namespace knead::iges {
namespace {

class Parts {
 public:
  explicit Parts(const std::vector<std::string>& values) : values_(values) {}

  void read(int type) {
    switch (type) {
      case 102:
      case 180:
      case 184:
        return use_list(1, 2, 1);
      case 118:
      case 120:
      case 190:
      case 192:
      case 194:
      case 196:
      case 198:
        use({1, 2});
        return use(type == 190                  ? std::initializer_list<std::size_t>{3}
                   : type == 192                ? std::initializer_list<std::size_t>{4}
                   : type == 196                ? std::initializer_list<std::size_t>{3, 4}
                   : type == 194 || type == 198 ? std::initializer_list<std::size_t>{5}
                                                : std::initializer_list<std::size_t>{});
      case 108:
        return use({5});
      case 122:
      case 162:
      case 164:
      case 408:
      case 430:
        return use({1});
      case 130:
        return use({1, 3});
      case 140:
        return use({5});
      case 141:
        return note_boundary();
      case 142:
        return use({2, 3, 4});
      case 143:
        use({2});
        return use_list(3, 4, 1);
      case 144:
        use({1, 4});
        return use_list(3, 5, 1);
      case 504:
        return use_list(1, 2, 5);
      case 508:
        return note_loop();
      case 510:
        use({1});
        return use_list(2, 4, 1);
      default:
        return;
    }
  }

  [[nodiscard]] std::vector<int> take() && { return std::move(parts_); }

 private:
  [[nodiscard]] int pointer(std::size_t k) const { return pointer_at(values_, k); }

  void use(std::initializer_list<std::size_t> places) {
    for (const std::size_t k : places) parts_.push_back(pointer(k));
  }

  void use_list(std::size_t count_at, std::size_t first, std::size_t step) {
    for (int n = pointer(count_at); n > 0 && first < values_.size(); --n, first += step)
      parts_.push_back(pointer(first));
  }

  void note_boundary() {
    parts_.push_back(pointer(3));
    std::size_t at = 5;
    for (int n = pointer(4); n > 0 && at + 2 < values_.size(); --n) {
      const auto flat = static_cast<std::size_t>(pointer(at + 2));
      parts_.push_back(pointer(at));
      for (std::size_t k = at + 3; k < at + 3 + flat && k < values_.size(); ++k)
        parts_.push_back(pointer(k));
      at += 3 + flat;
    }
  }

  void note_loop() {
    // Of each: kind, list, its entry, sense, number of curves in parameters, and these.
    std::size_t at = 2;
    for (int n = pointer(1); n > 0 && at + 4 < values_.size(); --n) {
      const auto flat = static_cast<std::size_t>(pointer(at + 4));
      for (std::size_t k = 0; k < flat && at + 6 + 2 * k < values_.size(); ++k)
        parts_.push_back(pointer(at + 6 + 2 * k));
      at += 5 + 2 * flat;
    }
  }

  const std::vector<std::string>& values_;
  std::vector<int> parts_;
};

}  // namespace

int pointer_at(const std::vector<std::string>& values, std::size_t k) {
  const int value = k < values.size() ? integer(values[k]).value_or(0) : 0;
  return std::abs(std::max(value, -std::numeric_limits<int>::max()));
}

std::vector<int> parts_of(int type, const std::vector<std::string>& values) {
  Parts parts(values);
  parts.read(type);
  return std::move(parts).take();
}

}  // namespace knead::iges
