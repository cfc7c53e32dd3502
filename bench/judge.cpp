#include "judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace knead::bench {

std::vector<std::string> unexpected_counts(const Measured& expected, const Measured& counted,
                                           double share) {
  std::vector<std::string> sentences;
  for (const auto& [kernel, wanted] : expected) {
    const auto found = counted.find(kernel);
    if (found == counted.end()) {
      sentences.push_back(fmt::format("{}: not counted", kernel));
    } else if (!(std::abs(found->second - wanted) <= share * wanted)) {
      sentences.push_back(fmt::format("{}: {:.0f} instructions instead of {:.0f}, {:+.1f} %",
                                      kernel, found->second, wanted,
                                      100 * (found->second / wanted - 1)));
    }
  }
  for (const auto& [kernel, count] : counted) {
    if (!expected.contains(kernel))
      sentences.push_back(fmt::format("{}: {:.0f}, and none expected", kernel, count));
  }
  return sentences;
}

std::vector<std::string> slower_in_every_round(std::span<const Measured> base,
                                               std::span<const Measured> head, double share) {
  std::vector<std::string> names;
  const std::size_t rounds = std::min(base.size(), head.size());
  if (rounds == 0) return names;
  for (const auto& entry : head[0]) {
    const std::string& name = entry.first;
    const auto slower = [&](std::size_t k) {
      const auto b = base[k].find(name), h = head[k].find(name);
      return b != base[k].end() && h != head[k].end() && h->second > (1 + share) * b->second;
    };
    std::size_t k = 0;
    while (k < rounds && slower(k)) ++k;
    if (k == rounds) names.push_back(name);
  }
  return names;
}

}  // namespace knead::bench
