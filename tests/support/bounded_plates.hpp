#pragma once

#include <functional>
#include <string>
#include <vector>

#include "support/bounded_sheets.hpp"
#include "support/made_iges.hpp"

namespace knead::testing {

/// How a surface is bounded in an IGES file without a B-rep.
enum class IgesBounding {
  bounded,        ///< 143 by 141, curves in space
  trimmed,        ///< 144 by 142, curves in space and in parameters
  in_parameters,  ///< 144 by 142, curves in parameters alone
};
inline constexpr std::array all_iges_boundings = {IgesBounding::bounded, IgesBounding::trimmed,
                                                  IgesBounding::in_parameters};
inline std::string name_of(IgesBounding bounding) {
  constexpr const char* names[] = {"bounded", "trimmed", "in_parameters"};
  return names[static_cast<int>(bounding)];
}

/// Parameters of a B-spline surface (128).
inline std::string spline_parameters(const Surface& s) {
  const auto [m, n] = s.net();
  std::string text =
      fmt::format("{},{},{},{},0,0,1,0,0", m - 1, n - 1, s.knots(0).degree(), s.knots(1).degree());
  for (int d = 0; d < 2; ++d) {
    for (const double t : s.knots(d).knots()) text += "," + StepBuilder::real(t);
  }
  for (int k = 0; k < m * n; ++k) text += ",1.";
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) {
      for (int c = 0; c < 3; ++c) text += "," + StepBuilder::real(s.control_points()(i * n + j, c));
    }
  }
  return text + ",0.,1.,0.,1.";
}

/// The roof over [0, 4] × [0, 2] times `scale`, as two surfaces that meet smoothly at x = 2; or the
/// west one alone. \param unit "M", "MM" or "IN"
inline BoundedSheets bounded_plates(IgesBounding bounding, const std::string& unit, double scale,
                                    bool with_east = true) {
  IgesBuilder b;
  const auto at = b.global.find("2,2HMM");
  b.global.replace(at, 6, unit == "M" ? "6,1HM" : unit == "IN" ? "1,2HIN" : "2,2HMM");
  BoundedSheets result;
  result.scale = scale;
  struct Sheet {
    std::array<double, 2> x, u, v;
  };
  const std::array<Sheet, 2> sheets = {{{{0, 2}, {-1, 3}, {-1, 3}}, {{2, 4}, {1, 6}, {-0.5, 2.5}}}};
  for (std::size_t k = 0; k < (with_east ? 2U : 1U); ++k) {
    const auto& [x, u, v] = sheets[k];
    const Surface patch = roof_patch(u, v, {12, 10});
    const int surface =
        b.add(128, spline_parameters(*patch.with_control_points(scale * patch.control_points())));
    const std::array<std::array<double, 2>, 4> corner = {
        {{x[0], 0}, {x[1], 0}, {x[1], 2}, {x[0], 2}}};
    std::vector<int> space, flat;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto p = corner[c], q = corner[(c + 1) % 4];
      const auto place = [&](const std::array<double, 2>& r, const std::array<double, 2>& to) {
        return fmt::format(
            "{},{},{}", StepBuilder::real(scale * (r[0] + to[0]) / 2),
            StepBuilder::real(scale * (r[1] + to[1]) / 2),
            StepBuilder::real(scale * (1 + roof_x(r[0], to[0]) + roof_y(r[1], to[1]))));
      };
      const auto fraction = [&](const std::array<double, 2>& r) {
        return fmt::format("{},{},0.", StepBuilder::real((r[0] - u[0]) / (u[1] - u[0])),
                           StepBuilder::real((r[1] - v[0]) / (v[1] - v[0])));
      };
      if (bounding != IgesBounding::in_parameters)
        space.push_back(
            b.add(126, fmt::format("2,2,0,0,1,0,0.,0.,0.,1.,1.,1.,1.,1.,1.,{},{},{},0.,1.,0.,0.,1.",
                                   place(p, p), place(p, q), place(q, q))));
      flat.push_back(b.add(110, fraction(p) + "," + fraction(q)));
    }
    const auto joined = [&](const std::vector<int>& curves) {
      std::string parts = std::to_string(curves.size());
      for (const int curve : curves) parts += fmt::format(",{}", curve);
      return b.add(102, parts);
    };
    int face = 0;
    if (bounding == IgesBounding::bounded) {
      std::string parts = fmt::format("1,1,{},4", surface);
      for (std::size_t c = 0; c < 4; ++c) parts += fmt::format(",{},1,1,{}", space[c], flat[c]);
      face = b.add(143, fmt::format("1,{},1,{}", surface, b.add(141, parts)));
    } else {
      const int in_space = bounding == IgesBounding::trimmed ? joined(space) : 0;
      const int on = b.add(142, fmt::format("1,{},{},{},{}", surface, joined(flat), in_space,
                                            in_space == 0 ? 1 : 2));
      face = b.add(144, fmt::format("{},1,0,{}", surface, on));
    }
    result.surfaces[k] = fmt::format("#{}", surface);
    result.faces[k] = fmt::format("#{}", face);
  }
  result.text = b.text();
  return result;
}

/// A made file of two surfaces that meet, of 20 m in all.
struct MadeSheets {
  std::string name;
  std::string ending;
  std::function<BoundedSheets()> make;
};

inline std::vector<MadeSheets> all_sheets() {
  std::vector<MadeSheets> result;
  for (const std::string unit : {"m", "mm"}) {
    const double scale = unit == "m" ? 5 : 5000;
    for (const Bounding bounding : all_boundings)
      result.push_back({name_of(bounding) + "_" + unit, ".step",
                        [=] { return bounded_sheets(bounding, unit, scale); }});
    for (const IgesBounding bounding : all_iges_boundings)
      result.push_back({"iges_" + name_of(bounding) + "_" + unit, ".igs",
                        [=] { return bounded_plates(bounding, unit == "m" ? "M" : "MM", scale); }});
  }
  return result;
}

}  // namespace knead::testing
