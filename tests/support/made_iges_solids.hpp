#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "exchange/iges_builder.hpp"

/// IGES solids whose faces look where flags say, and rings whose boundaries are closed twice.
namespace knead::testing {

inline std::string iges_global(const std::string& unit) {
  return "1H,,1H;,3HBox,7HBox.igs,5HMaker,3H1.0,32,38,6,308,15,3HBox,1.," + unit +
         ",1,0.01,15H20240101.000000,1E-6,100.,,,11,0,15H20240101.000000;";
}

/// A box as a shell (514) of bilinear faces (510), its edges (504) and vertices (502) shared.
/// \param turned of the six sides, by bits: those whose surfaces look into the box. \param
/// flags_turned all flags say the opposite.
inline int iges_box_shell(IgesBuilder& b, const std::array<double, 3>& low,
                          const std::array<double, 3>& high, unsigned turned, bool flags_turned) {
  const auto place = [&](int k) {
    const auto at = [&](int c) {
      return (((k >> c) & 1) != 0 ? high : low)[static_cast<std::size_t>(c)];
    };
    return fmt::format("{:.3f},{:.3f},{:.3f}", at(0), at(1), at(2));
  };
  std::string places = "8", ends = "12";
  for (int k = 0; k < 8; ++k) places += "," + place(k);
  const int vertices = b.add(502, places, 0, 1);
  std::array<std::array<int, 8>, 8> edge = {};
  int count = 0;
  for (int k = 0; k < 8; ++k) {
    for (const int bit : {1, 2, 4}) {
      if ((k & bit) != 0) continue;
      edge[static_cast<std::size_t>(k)][static_cast<std::size_t>(k | bit)] = ++count;
      const int line = b.add(110, place(k) + "," + place(k | bit));
      ends += fmt::format(",{},{},{},{},{}", line, vertices, k + 1, vertices, (k | bit) + 1);
    }
  }
  const int list = b.add(504, ends, 0, 1);
  // Counterclockwise from outside.
  constexpr std::array<std::array<int, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::string shell = "6";
  for (std::size_t f = 0; f < 6; ++f) {
    const bool inwards = ((turned >> f) & 1U) != 0;
    std::array<int, 4> side = sides[f];
    if (inwards) std::swap(side[1], side[3]);  // the surface and the loop round its normal
    const int surface = b.add(128, "1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.," +
                                       place(side[0]) + "," + place(side[1]) + "," +
                                       place(side[3]) + "," + place(side[2]) + ",0.,1.,0.,1.");
    std::string loop = "4";
    for (std::size_t k = 0; k < 4; ++k) {
      const int from = side[k], to = side[(k + 1) % 4];
      const int at = edge[static_cast<std::size_t>(std::min(from, to))]
                         [static_cast<std::size_t>(std::max(from, to))];
      loop += fmt::format(",0,{},{},{},0", list, at, from < to ? 1 : 0);
    }
    const int face = b.add(510, fmt::format("{},1,1,{}", surface, b.add(508, loop, 0, 1)), 0, 1);
    shell += fmt::format(",{},{}", face, inwards != flags_turned ? 0 : 1);
  }
  return b.add(514, shell, 0, 1);
}

/// 3 × 2 × 1, in mm; some surfaces look into it.
inline std::string iges_box_of_turned_faces() {
  IgesBuilder b;
  b.add(186, fmt::format("{},1,0", iges_box_shell(b, {0, 0, 0}, {3, 2, 1}, 0b010110, false)));
  return b.text();
}

/// The same in metres; the flags of its shell are all turned, and so is that of the solid.
inline std::string iges_box_of_a_turned_shell() {
  IgesBuilder b;
  b.global = iges_global("6,1HM");
  b.add(186, fmt::format("{},0,0", iges_box_shell(b, {0, 0, 0}, {3, 2, 1}, 0b101001, true)));
  return b.text();
}

/// In inch, with a void of 1 × 1 × 0.5, whose shell looks out of the void into the material.
inline int iges_hollow_solid(IgesBuilder& b) {
  b.global = iges_global("1,4HINCH");
  const int outer = iges_box_shell(b, {0, 0, 0}, {3, 2, 1}, 0b000001, false);
  const int inner = iges_box_shell(b, {1, 0.5, 0.25}, {2, 1.5, 0.75}, 0b110000, false);
  return b.add(186, fmt::format("{},1,1,{},0", outer, inner));
}
inline std::string iges_hollow_box() {
  IgesBuilder b;
  iges_hollow_solid(b);
  return b.text();
}

/// Two of them, instances of a subfigure.
inline std::string iges_hollow_boxes() {
  IgesBuilder b;
  const int figure = b.add(308, fmt::format("0,3HBox,1,{}", iges_hollow_solid(b)));
  for (const int x : {0, 10}) b.add(408, fmt::format("{},{}.,0.,0.,1.", figure, x));
  return b.text();
}

/// A full circle about z as a rational spline of degree 2 whose first point is off by a billionth,
/// as writers leave it.
inline int iges_circle(IgesBuilder& b, double radius, double z, bool backwards) {
  std::string weights, points;
  for (int k = 0; k <= 8; ++k) {
    const double angle = (backwards ? -1 : 1) * k * std::numbers::pi / 4;
    const double reach = radius * (k % 2 == 1 ? std::numbers::sqrt2 : 1);
    weights += k % 2 == 1 ? ",0.70710678118654757" : ",1.";
    points += fmt::format(",{:.17g},{:.17g},{:.17g}", reach * std::cos(angle),
                          k == 8   ? 0
                          : k == 0 ? 1e-9 * radius
                                   : reach * std::sin(angle),
                          z);
  }
  return b.add(126, "8,2,0,1,0,0,0.,0.,0.,1.,1.,2.,2.,3.,3.,4.,4.,4." + weights + points +
                        ",0.,4.,0.,0.,1.");
}

/// A ring of revolution (120) of a line about z, trimmed (144) by circle, seam, circle and seam.
/// \param back all of the boundary runs the other way
inline std::string iges_ring(const std::string& unit, std::array<double, 2> radius, double height,
                             bool back) {
  IgesBuilder b;
  b.global = iges_global(unit);
  const auto line = [&](bool down) {
    const std::string low = fmt::format("{:.17g},0.,0.", radius[0]),
                      high = fmt::format("{:.17g},0.,{}", radius[1], height);
    return b.add(110, down ? high + "," + low : low + "," + high);
  };
  const int axis = b.add(110, "0.,0.,0.,0.,0.,1."), profile = line(false);
  const int surface = b.add(120, fmt::format("{},{},0.,6.2831853071795862", axis, profile));
  const int low = iges_circle(b, radius[0], 0, back), up = line(false),
            high = iges_circle(b, radius[1], height, !back), down = line(true);
  const int loop = b.add(102, fmt::format("4,{},{},{},{}", low, up, high, down));
  b.add(144,
        fmt::format("{},1,0,{}", surface, b.add(142, fmt::format("1,{},0,{},2", surface, loop))));
  return b.text();
}
inline std::string iges_ring_in_mm() { return iges_ring("2,2HMM", {3, 2}, 1, false); }
inline std::string iges_ring_in_inch_backwards() { return iges_ring("1,4HINCH", {4, 7}, 4, true); }

/// A cylinder of radius 2 and height 3 as a solid (186): its side a surface of revolution (120),
/// whose normal looks inwards where its line runs up, its ends planes (190) that both look up.
inline std::string iges_drum(const std::string& unit, bool up) {
  IgesBuilder b;
  b.global = iges_global(unit);
  const int vertices = b.add(502, "2,2.,0.,0.,2.,0.,3.", 0, 1);
  const int low = b.add(100, "0.,0.,0.,2.,0.,2.,0."), high = b.add(100, "3.,0.,0.,2.,0.,2.,0."),
            seam = b.add(110, "2.,0.,0.,2.,0.,3.");
  const int edges = b.add(
      504,
      fmt::format("3,{1},{0},1,{0},1,{2},{0},2,{0},2,{3},{0},1,{0},2", vertices, low, high, seam),
      0, 1);
  const int axis = b.add(110, "0.,0.,0.,0.,0.,1."),
            line = up ? b.add(110, "2.,0.,0.,2.,0.,3.") : b.add(110, "2.,0.,3.,2.,0.,0.");
  const auto use = [&](int edge, bool along) {
    return fmt::format(",0,{},{},{},0", edges, edge, along ? 1 : 0);
  };
  const auto face = [&](int surface, const std::string& loop) {
    return b.add(510, fmt::format("{},1,1,{}", surface, b.add(508, loop, 0, 1)), 0, 1);
  };
  const int side = face(b.add(120, fmt::format("{},{},0.,6.2831853071795862", axis, line)),
                        up ? "4" + use(3, true) + use(2, true) + use(3, false) + use(1, false)
                           : "4" + use(1, true) + use(3, true) + use(2, false) + use(3, false));
  const int normal = b.add(123, "0.,0.,1.");
  const auto end = [&](int circle, const std::string& middle) {
    return face(b.add(190, fmt::format("{},{}", b.add(116, middle + ",0"), normal)),
                "1" + use(circle, true));
  };
  const int bottom = end(1, "0.,0.,0."), top = end(2, "0.,0.,3.");
  b.add(186, fmt::format("{},1,0",
                         b.add(514, fmt::format("3,{},{},{},0,{},1", side, up ? 0 : 1, bottom, top),
                               0, 1)));
  return b.text();
}
inline std::string iges_drum_in_mm() { return iges_drum("2,2HMM", true); }
inline std::string iges_drum_in_inch() { return iges_drum("1,4HINCH", false); }

/// A hemisphere of radius 2 over z = 0 as a trimmed surface of revolution that ends in a pole, as
/// close to the axis as writers leave it. \param up its quarter of a circle runs from the rim to
/// the pole
inline std::string iges_dome(const std::string& unit, bool up) {
  IgesBuilder b;
  b.global = iges_global(unit);
  const auto quarter = [&](bool rising) {
    return b.add(126,
                 std::string("2,2,1,0,0,0,0.,0.,0.,1.,1.,1.,1.,0.70710678118654757,1.,") +
                     (rising ? "2.,0.,0.,2.,0.,2.,4.E-7,0.,2." : "4.E-7,0.,2.,2.,0.,2.,2.,0.,0.") +
                     ",0.,1.,0.,1.,0.");
  };
  const int axis = b.add(110, "0.,0.,0.,0.,0.,1."), profile = quarter(up);
  const int surface = b.add(120, fmt::format("{},{},0.,6.2831853071795862", axis, profile));
  const int rising = quarter(true), falling = quarter(false), rim = iges_circle(b, 2, 0, up);
  const int loop = up ? b.add(102, fmt::format("3,{},{},{}", rising, falling, rim))
                      : b.add(102, fmt::format("3,{},{},{}", falling, rim, rising));
  b.add(144,
        fmt::format("{},1,0,{}", surface, b.add(142, fmt::format("1,{},0,{},2", surface, loop))));
  return b.text();
}
inline std::string iges_dome_in_metres() { return iges_dome("6,1HM", true); }
inline std::string iges_dome_in_inch() { return iges_dome("1,4HINCH", false); }

}  // namespace knead::testing
