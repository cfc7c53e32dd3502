#include <array>
#include <cmath>
#include <cstdio>

#include "knead/spline/evaluate.hpp"

// The bilinear patch x = u, y = v, z = u v at its middle; and a knot vector that must be refused,
// by value.
int main() {
  const auto knots = knead::KnotVector::create(1, {0, 0, 1, 1});
  if (!knots) return 1;
  knead::Points net(4, 3);
  net << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1;
  const auto surface = knead::Surface::create({*knots, *knots}, net);
  if (!surface) return 1;
  const auto middle = knead::evaluate_point<2>(*surface, std::array{0.5, 0.5});
  if (!middle || (*middle - knead::Point(0.5, 0.5, 0.25)).norm() != 0) return 1;

  const auto refused = knead::KnotVector::create(1, {0, 1, 0, 1});
  if (refused || refused.error().where != "knot 2") return 1;
  std::printf("%s\n", refused.error().message().c_str());
  return 0;
}
