#include "knead/image/image.hpp"

// The spline through the pixels of a ramp is the ramp: 1/2 between a pixel of 0 and one of 1.
int main() {
  knead::Image ramp{5, 5, std::vector<double>(25)};
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) ramp.at(x, y) = x < 2 ? 0 : 1;
  }
  if (!knead::check_image(ramp)) return 1;
  const knead::ImageSpline spline(ramp);
  return spline.value(1.5, 2) > 0.45 && spline.value(1.5, 2) < 0.55 ? 0 : 1;
}
