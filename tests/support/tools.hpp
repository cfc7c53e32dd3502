#pragma once

#include <gtest/gtest.h>

#include "knead/tool/tool.hpp"

namespace knead::testing {

inline PlacedShape sphere_at(const Point& centre, double radius) {
  auto made =
      PlacedShape::create(SphereShape{radius}, {Eigen::Quaterniond::Identity(), centre, {1, 1, 1}});
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

inline void move_to(Tool& tool, const Point& position) {
  tool.shape = *tool.shape.moved(tool.shape.placement().rotation, position);
}

}  // namespace knead::testing
