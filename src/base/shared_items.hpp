#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace knead {

/// A list of large items whose copies share those that neither has changed: a history of states,
/// each with all items, needs the memory of one and of what was changed.
///
/// Reading never copies; an item is copied when it is asked for to be changed and another list has
/// it too. Copying a list costs a pointer per item. Equality is that of the items. Not thread-safe.
template <class T>
class SharedItems {
  using Pointers = std::vector<std::shared_ptr<T>>;

 public:
  using value_type = T;

  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = const T*;
    using reference = const T&;

    Iterator() = default;
    explicit Iterator(typename Pointers::const_iterator at) : at_(at) {}
    reference operator*() const { return **at_; }
    pointer operator->() const { return at_->get(); }
    reference operator[](difference_type n) const { return **(at_ + n); }
    Iterator& operator++() { return *this += 1; }
    Iterator operator++(int) { return Iterator(at_++); }
    Iterator& operator--() { return *this -= 1; }
    Iterator operator--(int) { return Iterator(at_--); }
    Iterator& operator+=(difference_type n) {
      at_ += n;
      return *this;
    }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    friend Iterator operator+(Iterator a, difference_type n) { return a += n; }
    friend Iterator operator+(difference_type n, Iterator a) { return a += n; }
    friend Iterator operator-(Iterator a, difference_type n) { return a -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) { return a.at_ - b.at_; }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }
    friend auto operator<=>(const Iterator& a, const Iterator& b) { return a.at_ <=> b.at_; }

   private:
    typename Pointers::const_iterator at_;
  };

  SharedItems() = default;

  [[nodiscard]] std::size_t size() const { return items_.size(); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] const T& operator[](std::size_t k) const { return *items_[k]; }
  [[nodiscard]] const T& front() const { return *items_.front(); }
  [[nodiscard]] const T& back() const { return *items_.back(); }
  [[nodiscard]] Iterator begin() const { return Iterator(items_.begin()); }
  [[nodiscard]] Iterator end() const { return Iterator(items_.end()); }

  /// To be changed, in this list alone.
  [[nodiscard]] T& operator[](std::size_t k) {
    if (items_[k].use_count() > 1) items_[k] = std::make_shared<T>(std::as_const(*items_[k]));
    return *items_[k];
  }
  [[nodiscard]] T& front() { return (*this)[0]; }
  [[nodiscard]] T& back() { return (*this)[size() - 1]; }

  void reserve(std::size_t size) { items_.reserve(size); }
  void push_back(T item) { items_.push_back(std::make_shared<T>(std::move(item))); }
  T& emplace_back() {
    items_.push_back(std::make_shared<T>());
    return *items_.back();
  }
  void clear() { items_.clear(); }
  void resize(std::size_t size) {
    const std::size_t before = items_.size();
    items_.resize(size);
    for (std::size_t k = before; k < size; ++k) items_[k] = std::make_shared<T>();
  }
  void erase(Iterator at) { items_.erase(items_.begin() + (at - begin())); }

  friend bool operator==(const SharedItems& a, const SharedItems& b) {
    return std::ranges::equal(a.items_, b.items_,
                              [](const auto& x, const auto& y) { return x == y || *x == *y; });
  }

 private:
  Pointers items_;
};

}  // namespace knead
