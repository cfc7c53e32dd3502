// The way of a brush over a closed surface.
#include "session/gestures/brush_path.hpp"

#include <gtest/gtest.h>

namespace knead {
namespace {

/// A tube of a square of side 2, of length 4, closed in this direction.
Surface tube(std::size_t closed) {
  constexpr double corners[5][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1}};
  Points points(10, 3);
  for (int k = 0; k < 5; ++k) {
    for (int end = 0; end < 2; ++end)
      points.row(closed == 0 ? 2 * k + end : 5 * end + k) << corners[k][0], corners[k][1], 4 * end;
  }
  const KnotVector around = *KnotVector::clamped_uniform(1, 5, 0, 3),
                   along = *KnotVector::clamped_uniform(1, 2, 0, 1);
  return *Surface::create(closed == 0 ? std::array{around, along} : std::array{along, around},
                          points);
}

TEST(BrushPath, TakesTheShorterWayAroundInEitherDirection) {
  for (std::size_t d = 0; d < 2; ++d) {
    const auto shape = std::make_shared<const Surface>(tube(d));
    const int selection[] = {0};
    const OpenStroke::Before shapes[] = {{shape, shape}};
    const BrushPath path(selection, shapes, 0.11, 0);
    for (const bool back : {false, true}) {
      BrushPoint from, to;
      from.at[d] = back ? 0.1 : 0.9;
      to.at[d] = 1 - from.at[d];
      from.at[1 - d] = to.at[1 - d] = 0.5;
      const auto places = path.places(from, to, from);
      ASSERT_TRUE(places) << places.error().message();
      EXPECT_EQ(places->size(), 15U)
          << "0.2 of a circumference of 8, a place every 0.11; direction " << d;
      for (const BrushPoint& p : *places) {
        EXPECT_LE(std::min(p.at[d], 1 - p.at[d]), 0.1 + 1e-12) << p.at[d];
        EXPECT_EQ(p.at[1 - d], 0.5);
      }
      EXPECT_EQ(places->back().at, to.at);
    }
  }
}

}  // namespace
}  // namespace knead
