#pragma once

#include <string>
#include <vector>

#include "support/made_files.hpp"

namespace knead::testing {

/// How a surface is bounded by curves alone, without a face.
enum class Bounding {
  surface_curves,  ///< CURVE_BOUNDED_SURFACE, an OUTER_BOUNDARY_CURVE of SURFACE_CURVEs
  limited_curves,  ///< the same, whose curves in space are limited and run against the boundary
                   ///< here and there
  parameters,      ///< CURVE_BOUNDED_SURFACE, an OUTER_BOUNDARY_CURVE of PCURVEs
  rectangles,      ///< RECTANGULAR_TRIMMED_SURFACE
  holes,           ///< CURVE_BOUNDED_SURFACE by its own limits, and a circle in its parameters: a
                   ///< BOUNDARY_CURVE
};
inline constexpr std::array all_boundings = {Bounding::surface_curves, Bounding::limited_curves,
                                             Bounding::parameters, Bounding::rectangles,
                                             Bounding::holes};

inline std::string name_of(Bounding bounding) {
  constexpr const char* names[] = {"surface_curves", "limited_curves", "parameters", "rectangles",
                                   "holes"};
  return names[static_cast<int>(bounding)];
}

/// The roof over [0, 4] × [0, 2] times `scale` (`roof`), as two surfaces that meet smoothly at x
/// = 2.
struct BoundedSheets {
  std::string text;
  std::array<std::string, 2> surfaces, faces;  ///< west and east
  double scale = 1;
};

/// Writes one of them.
class BoundedSheetBuilder : public StepBuilder {
 public:
  BoundedSheetBuilder(Bounding bounding, double scale) : bounding_(bounding), scale_(scale) {}

  int bounded(int surface, std::array<double, 2> x, std::array<double, 2> y,
              std::array<double, 2> u, std::array<double, 2> v) {
    surface_ = surface;
    u_ = u;
    v_ = v;
    if (bounding_ == Bounding::rectangles) {
      const auto p = parameters(x[0], y[0]), q = parameters(x[1], y[1]);
      return entity(fmt::format("RECTANGULAR_TRIMMED_SURFACE('',#{},{},{},{},{},.T.,.T.)", surface,
                                real(p[0]), real(q[0]), real(p[1]), real(q[1])));
    }
    if (bounding_ == Bounding::holes) {
      const int centre = entity("CARTESIAN_POINT('',(0.5,0.5))"),
                frame = entity(fmt::format("AXIS2_PLACEMENT_2D('',#{},$)", centre));
      const int circle = entity(fmt::format("CIRCLE('',#{},0.2)", frame));
      const int turned = segment(pcurve(circle), false);
      const int hole = entity(fmt::format("BOUNDARY_CURVE('',(#{}),.F.)", turned));
      return entity(fmt::format("CURVE_BOUNDED_SURFACE('',#{},(#{}),.T.)", surface, hole));
    }
    const std::array<std::array<double, 2>, 4> corner = {
        {{x[0], y[0]}, {x[1], y[0]}, {x[1], y[1]}, {x[0], y[1]}}};
    std::vector<int> segments;
    for (std::size_t k = 0; k < 4; ++k) segments.push_back(side(corner[k], corner[(k + 1) % 4], k));
    const int outer = entity(fmt::format("OUTER_BOUNDARY_CURVE('',({}),.F.)", list_of(segments)));
    return entity(fmt::format("CURVE_BOUNDED_SURFACE('',#{},(#{}),.F.)", surface, outer));
  }

 private:
  using Place = std::array<double, 2>;
  [[nodiscard]] Place parameters(double x, double y) const {
    return {(x - u_[0]) / (u_[1] - u_[0]), (y - v_[0]) / (v_[1] - v_[0])};
  }
  int segment(int curve, bool along) {
    return entity(
        fmt::format("COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,{},#{})", along ? ".T." : ".F.", curve));
  }
  int pcurve(int curve) {
    const int context = entity(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
        "REPRESENTATION_CONTEXT('2D SPACE',''))");
    const int flat =
        entity(fmt::format("DEFINITIONAL_REPRESENTATION('',(#{}),#{})", curve, context));
    return entity(fmt::format("PCURVE('',#{},#{})", surface_, flat));
  }
  int flat(Place a, Place b) {
    std::vector<int> ends;
    for (const Place& p : {parameters(a[0], a[1]), parameters(b[0], b[1])})
      ends.push_back(entity(fmt::format("CARTESIAN_POINT('',({},{}))", real(p[0]), real(p[1]))));
    return pcurve(entity(fmt::format(
        "B_SPLINE_CURVE_WITH_KNOTS('',1,({}),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.)",
        list_of(ends))));
  }
  int at(Place a, Place b) {
    return point(scale_ * (a[0] + b[0]) / 2, scale_ * (a[1] + b[1]) / 2,
                 scale_ * (1 + roof_x(a[0], b[0]) + roof_y(a[1], b[1])));
  }
  /// The roof above a line, over [0, 1].
  int above(Place a, Place b) {
    return entity(fmt::format(
        "B_SPLINE_CURVE_WITH_KNOTS('',2,({}),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.)",
        list_of({at(a, a), at(a, b), at(b, b)})));
  }
  int side(Place a, Place b, std::size_t k) {
    if (bounding_ == Bounding::parameters) return segment(flat(a, b), true);
    const bool limited = bounding_ == Bounding::limited_curves;
    const bool back = limited && k % 2 == 1;  // the curve runs against the boundary
    if (back) std::swap(a, b);
    int curve = 0;
    if (limited) {  // from 1/4 to 3/4 of a longer curve, that runs backwards on every side but the
                    // first
      const auto beyond = [](const Place& p, const Place& q) {
        return Place{1.5 * p[0] - 0.5 * q[0], 1.5 * p[1] - 0.5 * q[1]};
      };
      const bool turned = k > 0;
      const int whole =
          turned ? above(beyond(b, a), beyond(a, b)) : above(beyond(a, b), beyond(b, a));
      curve =
          entity(fmt::format("TRIMMED_CURVE('',#{},(#{},PARAMETER_VALUE({})),(#{},PARAMETER_VALUE({"
                             "})),{},.PARAMETER.)",
                             whole, at(a, a), turned ? "0.75" : "0.25", at(b, b),
                             turned ? "0.25" : "0.75", turned ? ".F." : ".T."));
    } else {
      curve = above(a, b);
    }
    const int on = entity(fmt::format("SURFACE_CURVE('',#{},(#{}),.CURVE_3D.)", curve, flat(a, b)));
    return segment(on, !back);
  }

  Bounding bounding_;
  double scale_;
  int surface_ = 0;
  std::array<double, 2> u_ = {0, 1}, v_ = {0, 1};
};

/// \param unit "m", "mm" or "inch"
inline BoundedSheets bounded_sheets(Bounding bounding, const std::string& unit, double scale) {
  BoundedSheetBuilder b(bounding, scale);
  const int context = b.context(unit);
  BoundedSheets result;
  result.scale = scale;
  std::vector<int> faces;
  // Holes are in the middle of surfaces that end where they are bounded.
  const bool whole = bounding == Bounding::holes;
  struct Sheet {
    std::array<double, 2> x, y, u, v;
  };
  const std::array<Sheet, 2> sheets = {
      {{{0, 2}, {0, 2}, {-1, 3}, {-1, 3}}, {{2, 4}, {0, 2}, {1, 6}, {-0.5, 2.5}}}};
  for (std::size_t k = 0; k < 2; ++k) {
    const Sheet& s = sheets[k];
    const auto& u = whole ? s.x : s.u;
    const auto& v = whole ? s.y : s.v;
    const Surface patch = roof_patch(u, v, {12, 10});
    const int surface = b.surface(*patch.with_control_points(scale * patch.control_points()),
                                  k == 0 ? "west" : "east");
    faces.push_back(b.bounded(surface, s.x, s.y, u, v));
    result.surfaces[k] = FaceBuilder::ref(surface);
    result.faces[k] = FaceBuilder::ref(faces.back());
  }
  const int set = b.entity(fmt::format("GEOMETRIC_SET('',({}))", FaceBuilder::list_of(faces)));
  b.product("sheets", "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION", {set}, context);
  result.text = b.forward("AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }");
  return result;
}

}  // namespace knead::testing
