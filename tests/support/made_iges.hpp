#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "exchange/iges_builder.hpp"
#include "knead/spline/spline_refinement.hpp"

/// IGES files as other systems write them: small ones, of every kind that foreign files show.
namespace knead::testing {

/// The parameters of a B-spline surface (128).
inline std::string iges_surface(const Surface& s) {
  const auto [m, n] = s.net();
  std::string text = fmt::format("{},{},{},{},0,0,{},0,0", m - 1, n - 1, s.knots(0).degree(),
                                 s.knots(1).degree(), s.rational() ? 0 : 1);
  for (int d = 0; d < 2; ++d) {
    for (const double knot : s.knots(d).knots()) text += fmt::format(",{:.17E}", knot);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      text += fmt::format(",{:.17E}",
                          s.rational() ? s.weights()[static_cast<std::size_t>(i * n + j)] : 1.0);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      const auto p = s.control_points().row(i * n + j);
      text += fmt::format(",{:.17E},{:.17E},{:.17E}", p[0], p[1], p[2]);
    }
  }
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  return text + fmt::format(",{:.17E},{:.17E},{:.17E},{:.17E}", u.lower, u.upper, v.lower, v.upper);
}

/// A flat bicubic sheet over [x, x + 4] × [0, 2], wider by 1 on every side, on knots of its own.
inline Surface wide_sheet(double x, int columns, int rows) {
  const KnotVector u = *KnotVector::clamped_uniform(3, columns),
                   v = *KnotVector::clamped_uniform(3, rows);
  Points points(columns * rows, 3);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j)
      points.row(i * rows + j) << x - 1 + 6 * u.greville(i), 4 * v.greville(j) - 1, 0;
  }
  return *Surface::create({u, v}, points);
}

inline std::string iges_corner(double x, int k) {
  return fmt::format("{:.17E},{}.,0.", x + (k % 4 == 1 || k % 4 == 2 ? 4 : 0), k % 4 > 1 ? 2 : 0);
}

/// Two trimmed surfaces side by side, as 142 on 144.
inline std::string trimmed_144() {
  IgesBuilder b;
  for (const double x : {0.0, 4.0}) {
    const int surface = b.add(128, iges_surface(wide_sheet(x, x > 0 ? 8 : 7, 6)));
    std::string parts = "4";
    for (int k = 0; k < 4; ++k)
      parts += fmt::format(",{}", b.add(110, iges_corner(x, k) + "," + iges_corner(x, k + 1)));
    const int curve = b.add(142, fmt::format("1,{},0,{},2", surface, b.add(102, parts)));
    b.add(144, fmt::format("{},1,0,{}", surface, curve));
  }
  return b.text();
}

/// The first of them with a boundary, as 141 on 143.
inline std::string bounded_143() {
  IgesBuilder b;
  const int surface = b.add(128, iges_surface(wide_sheet(0, 7, 6)));
  std::string boundary = fmt::format("0,1,{},4", surface);
  for (int k = 0; k < 4; ++k) {
    boundary += fmt::format(",{},1,0", b.add(110, iges_corner(0, k) + "," + iges_corner(0, k + 1)));
  }
  b.add(143, fmt::format("0,{},1,{}", surface, b.add(141, boundary)));
  return b.text();
}

/// A B-rep solid (186): a box of six bilinear surfaces, whose faces (510) share edges (504) and
/// vertices (502), in inch and with other delimiters.
inline std::string solid_186() {
  IgesBuilder b;
  b.separator = '/';
  b.terminator = '!';
  b.global =
      "1H//1H!/3HBox/7HBox.igs/5HMaker/3H1.0/32/38/6/308/15/3HBox/1./1/4HINCH/1/0.01/"
      "15H20240101.000000/1E-6/100.////11/0/15H20240101.000000!";
  const auto add = [&b](int type, std::string text, int form = 0) {
    std::ranges::replace(text, ',', '/');
    return b.add(type, text, 0, form);
  };
  const auto place = [](int k) {
    return fmt::format("{}.,{}.,{}.", 3 * (k & 1), 2 * ((k >> 1) & 1), (k >> 2) & 1);
  };
  std::string places = "8", ends = "12";
  for (int k = 0; k < 8; ++k) places += "," + place(k);
  const int vertices = add(502, places, 1);
  std::vector<std::array<int, 2>> edges;
  for (int k = 0; k < 8; ++k) {
    for (const int bit : {1, 2, 4}) {
      if ((k & bit) == 0) edges.push_back({k, k | bit});
    }
  }
  for (const auto& [a, c] : edges) {
    const int line = add(110, place(a) + "," + place(c));
    ends += fmt::format(",{},{},{},{},{}", line, vertices, a + 1, vertices, c + 1);
  }
  const int list = add(504, ends, 1);
  // Counterclockwise from outside.
  constexpr std::array<std::array<int, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::string shell = "6";
  for (const auto& side : sides) {
    const int surface =
        add(128, "1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.," + place(side[0]) + "," +
                     place(side[1]) + "," + place(side[3]) + "," + place(side[2]) + ",0.,1.,0.,1.");
    std::string loop = "4";
    for (std::size_t k = 0; k < 4; ++k) {
      const int from = side[k], to = side[(k + 1) % 4];
      const auto at = std::ranges::find(edges, std::array{std::min(from, to), std::max(from, to)});
      loop += fmt::format(",0,{},{},{},0", list, at - edges.begin() + 1, from < to ? 1 : 0);
    }
    shell +=
        fmt::format(",{},1", add(510, fmt::format("{},1,1,{}", surface, add(508, loop, 1)), 1));
  }
  add(186, fmt::format("{},1,0", add(514, shell, 1)));
  return b.text();
}

/// A surface that no face uses.
inline std::string bare_128() {
  IgesBuilder b;
  b.add(128, iges_surface(wide_sheet(0, 6, 5)));
  return b.text();
}

using MadeFile = std::pair<std::string, std::string (*)()>;
inline const std::vector<MadeFile> made_iges_files = {{"made_144.igs", trimmed_144},
                                                      {"made_143.igs", bounded_143},
                                                      {"made_186.iges", solid_186},
                                                      {"made_128.igs", bare_128}};

}  // namespace knead::testing
