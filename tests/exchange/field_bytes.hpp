#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "knead/spline/spline.hpp"

// Bytes of data files.

namespace knead::testing {

// Two points and their displacements, whose coordinates single precision holds too.
inline const std::vector<Point> places = {{0.5, -1.25, 3}, {4, 5.75, -6.5}};
inline const std::vector<Point> vectors = {{0.125, 0, -0.25}, {1, -2, 0.0625}};

/// The bytes of a number, in one of both orders.
template <class T>
void append_number(std::string& bytes, T value, bool big_endian) {
  std::array<char, sizeof(T)> own{};
  std::memcpy(own.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::ranges::reverse(own);
  bytes.append(own.data(), own.size());
}

/// The coordinates of points as such numbers.
template <class T>
std::string raw(const std::vector<Point>& points, bool big_endian) {
  std::string bytes;
  for (const Point& p : points) {
    for (const double x : p) append_number(bytes, static_cast<T>(x), big_endian);
  }
  return bytes;
}

/// STL of triangles, corner by corner.
inline std::string binary_stl(const std::vector<Point>& corners, std::string title) {
  title.resize(80, ' ');
  append_number(title, static_cast<std::uint32_t>(corners.size() / 3), false);
  for (std::size_t k = 0; k < corners.size(); k += 3)
    title += std::string(12, '\0') +
             raw<float>({corners[k], corners[k + 1], corners[k + 2]}, false) + std::string(2, '\0');
  return title;
}

inline std::string text_stl(const std::vector<Point>& corners) {
  std::string text = "solid part\n";
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k % 3 == 0) text += " facet normal 0 0 1\n  outer loop\n";
    text += "   vertex";
    for (const double x : corners[k]) text += " " + std::to_string(x);
    text += "\n";
    if (k % 3 == 2) text += "  endloop\n endfacet\n";
  }
  return text + "endsolid part\n";
}

inline const std::vector<Point> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                          {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};

}  // namespace knead::testing
