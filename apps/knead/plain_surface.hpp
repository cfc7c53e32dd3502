#pragma once

#include <array>
#include <string>

#include "cli.hpp"
#include "knead/spline/spline.hpp"

namespace knead::cli {

/// "3" or "3x2": one whole number per direction. A usage error names `option`.
[[nodiscard]] Expected<std::array<int, 2>> parse_pair(const std::string& text,
                                                      const std::string& option, bool one_for_both);

/// --knots-u, --knots-v and --weights: a surface over its own parameters, S(s, t) = (s, t, 0) where
/// it has no weights.
struct PlainSurfaceOption {
  std::string u, v, weights;

  void add_to(CLI::App& command, const std::string& purpose);
  [[nodiscard]] bool given() const { return !u.empty() && !v.empty(); }
  /// Usage errors: an entry that is not a number, and what `KnotVector` and `Surface` refuse.
  [[nodiscard]] Expected<Surface> read(const std::array<int, 2>& degree) const;
};

}  // namespace knead::cli
