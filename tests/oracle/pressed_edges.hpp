#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "knead/brep/visible_region.hpp"
#include "oracle/step_oracle.hpp"

namespace knead::oracle {

/// What is done at an edge: a ball pressed into it; a groove of half that radius led across; a
/// brush that grabs it.
enum class Motion { press, groove, grab };

/// An edge, the surfaces of its faces, and a ball of half the distance to the nearest other edge,
/// pressed into its middle by a quarter of its radius. The ball is not rigid: against a sharp edge
/// that is free to move, rigid contact may end on the far side of the tool (docs/trims.md).
struct Pair {
  std::vector<std::string> edges;
  std::vector<std::string> surfaces;
  Point place = Point::Zero(), normal = Point::Zero(), across = Point::Zero();
  double radius = 0, depth = 0;
  [[nodiscard]] std::string script(const brep::Model& file, Motion motion) const;
};

/// Up to four edges of a file shared by two surfaces, up to two more that are smooth, and up to two
/// at which a closed surface meets itself, spread over the file. \param wanted of the surfaces that
/// share an edge; none: all
[[nodiscard]] std::vector<Pair> pairs_of(
    const brep::Model& file,
    const std::function<bool(const std::vector<std::string>& surfaces)>& wanted = {});

/// One of each kind: an edge at which a surface meets itself, a smooth one and a sharp one; all of
/// them in a long run.
[[nodiscard]] std::vector<Pair> each_kind(const brep::Model& file, std::vector<Pair> pairs);

/// All inner edges of a shell, pressed in its middle.
[[nodiscard]] Pair chain_of(const brep::Model& file, const Point& place);

/// Moves the edge of a file at `path`, saves it in `directory`, and lets Open CASCADE measure: the
/// topology, faults, gaps and angles. The row of the table in docs/evidence/trims.md is printed,
/// and appended to the file that KNEAD_FOLLOW_TABLE names. \param least_reached share of the depth
/// that the place must reach; 0: motions may also be refused `file`: the one at `path`, or what a
/// reader of IGES has made of it.
void move(const fs::path& path, const brep::Model& file, const Pair& pair, Motion motion,
          const fs::path& directory, double least_reached);

}  // namespace knead::oracle
