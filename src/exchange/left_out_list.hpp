#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knead/exchange/source.hpp"

namespace knead::detail {

/// What things of one kind are called, and why they are left out.
struct LeftOutKind {
  std::string_view one, many, reason, remedy = {};
};

/// Counts what is left out, by kind and reason.
class LeftOutList {
 public:
  void add(const LeftOutKind& kind, std::string id = {}, std::size_t count = 1, int line = 0) {
    const auto [at, fresh] =
        places_.try_emplace({std::string(kind.many), std::string(kind.reason)}, list_.size());
    if (fresh) {
      list_.push_back({std::string(kind.one),
                       std::string(kind.many),
                       0,
                       std::string(kind.reason),
                       std::string(kind.remedy),
                       {},
                       line});
    }
    LeftOut& stored = list_[at->second];
    stored.count += count;
    if (!id.empty() && stored.ids.size() < LeftOut::most_ids) stored.ids.push_back(std::move(id));
  }
  /// In the order in which each was first added.
  [[nodiscard]] std::vector<LeftOut> take() { return std::move(list_); }

 private:
  std::vector<LeftOut> list_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;
};

}  // namespace knead::detail
