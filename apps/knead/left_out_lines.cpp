#include "left_out_lines.hpp"

#include "say.hpp"

namespace knead::cli {

void warn_left_out(const std::vector<LeftOut>& list) {
  for (const LeftOut& left : list) say(stderr, "knead: warning: left out: {}\n", sentence(left));
}

}  // namespace knead::cli
