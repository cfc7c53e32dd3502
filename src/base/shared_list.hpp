#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

namespace knead {

/// A list that grows at its end and whose copies share what they have in common: a history of
/// thousands of states, each with all records so far, needs the memory of one.
///
/// Copying n items costs O(n / 128); appending and changing one copy at most 128 items. Equality is
/// that of the items. Not thread-safe.
template <class T>
class SharedList {
 public:
  static constexpr std::size_t chunk = 128;  ///< copies share as many items, one beside the other

  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = const T*;
    using reference = const T&;

    Iterator() = default;
    Iterator(const SharedList* list, std::size_t at) : list_(list), at_(at) {}
    reference operator*() const { return (*list_)[at_]; }
    pointer operator->() const { return &(*list_)[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return {list_, at_++}; }
    Iterator& operator+=(difference_type n) {
      at_ = static_cast<std::size_t>(static_cast<difference_type>(at_) + n);
      return *this;
    }
    friend Iterator operator+(Iterator a, difference_type n) { return a += n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) {
      return static_cast<difference_type>(a.at_) - static_cast<difference_type>(b.at_);
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }

   private:
    const SharedList* list_ = nullptr;
    std::size_t at_ = 0;
  };

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const T& operator[](std::size_t k) const {
    return (*chunks_[k / chunk])[k % chunk];
  }
  [[nodiscard]] const T& front() const { return (*this)[0]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] Iterator begin() const { return {this, 0}; }
  [[nodiscard]] Iterator end() const { return {this, size_}; }

  void push_back(T item) {
    if (size_ % chunk == 0) {
      chunks_.push_back(std::make_shared<std::vector<T>>());
    } else {
      own_chunk(chunks_.size() - 1);
    }
    chunks_.back()->push_back(std::move(item));
    ++size_;
  }
  /// Item k, to be changed: in this list alone.
  [[nodiscard]] T& own(std::size_t k) {
    own_chunk(k / chunk);
    return (*chunks_[k / chunk])[k % chunk];
  }
  /// Only the first `size` items; no more than there are.
  void truncate(std::size_t size) {
    if (size >= size_) return;
    size_ = size;
    chunks_.resize((size + chunk - 1) / chunk);
    if (size % chunk == 0) return;
    own_chunk(chunks_.size() - 1);
    chunks_.back()->erase(chunks_.back()->begin() + static_cast<std::ptrdiff_t>(size % chunk),
                          chunks_.back()->end());
  }

  friend bool operator==(const SharedList& a, const SharedList& b) {
    if (a.size_ != b.size_) return false;
    for (std::size_t k = 0; k < a.chunks_.size(); ++k) {
      if (a.chunks_[k] != b.chunks_[k] && *a.chunks_[k] != *b.chunks_[k]) return false;
    }
    return true;
  }

 private:
  // Copy on write: a chunk that another list has is copied before it changes.
  void own_chunk(std::size_t k) {
    if (chunks_[k].use_count() > 1) chunks_[k] = std::make_shared<std::vector<T>>(*chunks_[k]);
  }

  std::vector<std::shared_ptr<std::vector<T>>>
      chunks_;  // full but for the last one; shared ones do not change
  std::size_t size_ = 0;
};

}  // namespace knead
