#pragma once

#include <string>

#include "cli.hpp"
#include "knead/spline/knot_vector.hpp"

namespace knead::cli {

/// --degree with --knots or --knots-file: the basis on which a sub-command works.
struct KnotsOption {
  int degree = 3;
  std::string knots, file;

  void add_to(CLI::App& command);
  /// Usage errors: neither or both are given, an entry is not a number. Input errors: the file
  /// cannot be read, or its content is not a knot vector of the degree; the index is named.
  [[nodiscard]] Expected<KnotVector> read() const;
};

}  // namespace knead::cli
