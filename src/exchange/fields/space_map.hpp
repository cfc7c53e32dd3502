#pragma once

#include <functional>
#include <string_view>

#include "knead/base/error.hpp"
#include "knead/spline/extremum.hpp"

namespace knead::fields {

/// A displacement at every point of space.
class SpaceMap {
 public:
  using Function = std::function<Expected<Point>(const Point&)>;

  explicit SpaceMap(Function displacement) : displacement_(std::move(displacement)) {}

  /// Three formulas of x, y and z (src/energy/formula.hpp), separated by semicolons; or "lattice:"
  /// and a block of space of which control points are moved, as JSON (docs/morph.md). \param model
  /// what the block is put round if it does not say where it is. Errors (input): there are not
  /// three formulas; those of `Formula::parse`, with which one it is; of `parse_json`,
  /// `read_record` and `Lattice`.
  [[nodiscard]] static Expected<SpaceMap> parse(std::string_view text,
                                                const BoundingBox& model = {});

  /// Errors (input): it is not finite at this point, which is named.
  [[nodiscard]] Expected<Point> at(const Point& place) const;

 private:
  Function displacement_;
};

}  // namespace knead::fields
