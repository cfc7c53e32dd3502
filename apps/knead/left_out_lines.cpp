#include "left_out_lines.hpp"

#include <fmt/format.h>
#include "say.hpp"

namespace knead::cli {

void print_left_out(const std::vector<LeftOut>& list) {
  if (!list.empty()) say("  left out:\n");
  for (const LeftOut& left : list) say("    {}\n", sentence(left));
}

void warn_left_out(const std::vector<LeftOut>& list) {
  for (const LeftOut& left : list) say(stderr, "knead: warning: left out: {}\n", sentence(left));
}

nlohmann::ordered_json left_out_json(const std::vector<LeftOut>& list) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (const LeftOut& left : list) {
    result.push_back({{"what", left.many},
                      {"count", left.count},
                      {"reason", left.reason},
                      {"remedy", left.remedy.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(left.remedy)},
                      {"ids", left.ids}});
  }
  return result;
}

}  // namespace knead::cli
