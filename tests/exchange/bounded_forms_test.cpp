// Planes, cylinders and the like that are bounded by parameters or curves alone.

#include <gtest/gtest.h>

#include <numbers>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/brep/face_conversion.hpp"
#include "support/made_step.hpp"

namespace knead {
namespace {

using testing::StepBuilder;
constexpr double pi = std::numbers::pi;

/// A surface that is bounded by itself, and its area.
struct BoundedForm {
  std::string name;
  double area;
  std::function<int(StepBuilder&)> make;
};

int rectangle(StepBuilder& b, int basis, double u1, double u2, double v1, double v2,
              const char* senses = ".T.,.T.") {
  return b.entity(fmt::format("RECTANGULAR_TRIMMED_SURFACE('',#{},{},{},{},{},{})", basis,
                              StepBuilder::real(u1), StepBuilder::real(u2), StepBuilder::real(v1),
                              StepBuilder::real(v2), senses));
}

/// A rectangle of parameters as four PCURVEs, or a limited line each.
int bounded_by_pcurves(StepBuilder& b, int basis, double u1, double u2, double v1, double v2) {
  const std::array<std::array<double, 2>, 4> corner = {{{u1, v1}, {u2, v1}, {u2, v2}, {u1, v2}}};
  std::vector<int> segments;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &p = corner[k], &q = corner[(k + 1) % 4];
    const int from = b.entity(fmt::format("CARTESIAN_POINT('',({},{}))", StepBuilder::real(p[0]),
                                          StepBuilder::real(p[1])));
    const int way = b.entity(fmt::format("DIRECTION('',({},{}))", StepBuilder::real(q[0] - p[0]),
                                         StepBuilder::real(q[1] - p[1])));
    const int vector = b.entity(fmt::format("VECTOR('',#{},2.)", way));
    const int line = b.entity(fmt::format("LINE('',#{},#{})", from, vector));
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    const int limited = b.entity(fmt::format(
        "TRIMMED_CURVE('',#{},(PARAMETER_VALUE(0.)),(PARAMETER_VALUE({})),.T.,.PARAMETER.)", line,
        StepBuilder::real(length / 2)));
    const int flat = b.entity(fmt::format("DEFINITIONAL_REPRESENTATION('',(#{}),#{})", limited,
                                          b.entity("REPRESENTATION_CONTEXT('','')")));
    const int pcurve = b.entity(fmt::format("PCURVE('',#{},#{})", basis, flat));
    segments.push_back(
        b.entity(fmt::format("COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#{})", pcurve)));
  }
  const int outer =
      b.entity(fmt::format("OUTER_BOUNDARY_CURVE('',({}),.F.)", StepBuilder::list_of(segments)));
  return b.entity(fmt::format("CURVE_BOUNDED_SURFACE('',#{},(#{}),.F.)", basis, outer));
}

int cylinder(StepBuilder& b) {
  return b.entity(fmt::format("CYLINDRICAL_SURFACE('',#{},1.5)", b.frame()));
}
int line(StepBuilder& b) {
  const int vector = b.entity(fmt::format("VECTOR('',#{},0.5)", b.direction(0, 0, 1)));
  return b.entity(fmt::format("LINE('',#{},#{})", b.point(2, 0, 0), vector));
}

const std::vector<BoundedForm>& forms() {
  static const std::vector<BoundedForm> all = {
      {"plane", 6,
       [](StepBuilder& b) {
         return rectangle(b, b.plane({1, 2, 3}, {0, 1, 1}, {1, 0, 0}), -1, 2, 3, 5);
       }},
      {"plane_turned", 6,
       [](StepBuilder& b) {
         return rectangle(b, b.plane({1, 2, 3}, {0, 1, 1}, {1, 0, 0}), -1, 2, 5, 3, ".T.,.F.");
       }},
      {"quarter_cylinder", 1.5 * pi / 2 * 4,
       [](StepBuilder& b) { return rectangle(b, cylinder(b), 1, 1 + pi / 2, -1, 3); }},
      {"over_the_seam", 1.5 * 2,
       [](StepBuilder& b) { return rectangle(b, cylinder(b), 2 * pi - 1, 1, 0, 1); }},
      {"whole_cylinder", 1.5 * 2 * pi * 2,
       [](StepBuilder& b) { return rectangle(b, cylinder(b), 0, 2 * pi, 0, 2); }},
      {"cap", 2 * pi * 4 * 0.5,
       [](StepBuilder& b) {
         return rectangle(b, b.entity(fmt::format("SPHERICAL_SURFACE('',#{},2.)", b.frame())), 0,
                          2 * pi, pi / 6, pi / 2);
       }},
      {"torus_part", 0.5 * 1.5 * (3 * 1.5 + 0.5 * 2 * std::sin(0.75)),
       [](StepBuilder& b) {
         return rectangle(b, b.entity(fmt::format("TOROIDAL_SURFACE('',#{},3.,0.5)", b.frame())), 1,
                          2.5, -0.75, 0.75);
       }},
      {"cone", 0.5 * 2 * (1 + 3) * 2 * std::sqrt(2.0),
       [](StepBuilder& b) {
         return rectangle(b,
                          b.entity(fmt::format("CONICAL_SURFACE('',#{},1.,{})", b.frame(),
                                               StepBuilder::real(pi / 4))),
                          0.5, 2.5, 0, 2);
       }},
      {"revolution", 2 * 2 * 0.75,
       [](StepBuilder& b) {
         const int axis = b.entity(fmt::format("AXIS1_PLACEMENT('',#{},$)", b.point(0, 0, 0)));
         return rectangle(b,
                          b.entity(fmt::format("SURFACE_OF_REVOLUTION('',#{},#{})", line(b), axis)),
                          0, 2, 0.5, 2);
       }},
      {"extrusion", 2 * 1.5,
       [](StepBuilder& b) {
         const int vector = b.entity(fmt::format("VECTOR('',#{},3.)", b.direction(0, 1, 0)));
         return rectangle(
             b, b.entity(fmt::format("SURFACE_OF_LINEAR_EXTRUSION('',#{},#{})", line(b), vector)),
             0, 4, 0, 0.5);
       }},
      {"plane_by_pcurves", 6,
       [](StepBuilder& b) {
         return bounded_by_pcurves(b, b.plane({1, 2, 3}, {0, 1, 1}, {1, 0, 0}), -1, 2, 3, 5);
       }},
      {"cylinder_by_pcurves", 1.5 * 1 * 2,
       [](StepBuilder& b) { return bounded_by_pcurves(b, cylinder(b), 0.5, 1.5, 0, 2); }},
  };
  return all;
}

std::string file_of(const BoundedForm& form, int& made) {
  StepBuilder b;
  const int context = b.context("mm");
  made = form.make(b);
  const int set = b.entity(fmt::format("GEOMETRIC_SET('',(#{}))", made));
  b.product("form", "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION", {set}, context);
  return b.forward("AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }");
}

class BoundedForms : public ::testing::TestWithParam<BoundedForm> {};

void expect_area(const Source& source, double area) {
  const auto mesh = model_faces(*source.model(), 1e-4);
  ASSERT_TRUE(mesh) << mesh.error().message();
  EXPECT_TRUE(mesh->skipped.empty()) << mesh->skipped[0].reason.message();
  ASSERT_EQ(mesh->faces.size(), 1U);
  EXPECT_NEAR(testing::area_of(mesh->faces[0]), area, 5e-4 * area);
}

TEST_P(BoundedForms, AreFaces) {
  int made = 0;
  const auto source = testing::open_or_die(file_of(GetParam(), made), "form.step");
  ASSERT_EQ(source->model()->faces.size(), 1U);
  EXPECT_EQ(source->model()->faces[0].id, StepBuilder::ref(made));
  EXPECT_TRUE(source->left_out().empty());
  expect_area(*source, GetParam().area);
}

TEST_P(BoundedForms, AreConverted) {
  int made = 0;
  const auto source = testing::open_or_die(file_of(GetParam(), made), "form.step");
  const std::vector<std::string> ids = {StepBuilder::ref(made)};
  const auto converted = source->with_splines(ids);
  ASSERT_TRUE(converted) << converted.error().message();
  ASSERT_EQ((*converted)->model()->faces.size(), 1U);
  EXPECT_NE((*converted)->model()->spline_under((*converted)->model()->faces[0]), nullptr);
  expect_area(**converted, GetParam().area);
}

INSTANTIATE_TEST_SUITE_P(Forms, BoundedForms, ::testing::ValuesIn(forms()),
                         [](const auto& instance) { return instance.param.name; });

TEST(BoundedForm, AnglesHaveTheUnitOfTheFile) {
  int made = 0;
  const BoundedForm quarter{"", 1.5 * pi / 2 * 2, [](StepBuilder& b) {
                              return rectangle(b, cylinder(b), 30, 120, 0, 2);
                            }};
  std::string text = file_of(quarter, made);
  const std::string radians = "(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))";
  const auto at = text.find(radians);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, radians.size(),
               "(CONVERSION_BASED_UNIT('DEGREE',#9001)NAMED_UNIT(#9003)PLANE_ANGLE_UNIT())");
  text.insert(
      text.find("DATA;\r\n") + 7,
      "#9001=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(1.7453292519943295E-2),#9002);\r\n"
      "#9002=" +
          radians + ";\r\n#9003=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);\r\n");
  expect_area(*testing::open_or_die(text, "form.step"), quarter.area);
}

TEST(BoundedForm, WhatCannotBeBoundedIsNamed) {
  const auto reason = [](const auto& make) {
    int made = 0;
    const auto source = testing::open_or_die(file_of({"", 0, make}, made), "form.step");
    const auto mesh = model_faces(*source->model(), 1e-4);
    return mesh && mesh->skipped.size() == 1 ? mesh->skipped[0].reason.message()
                                             : std::string("drawn");
  };
  EXPECT_NE(reason([](StepBuilder& b) {
              return rectangle(b, cylinder(b), 0, 1, 2, 2);
            }).find("enclose nothing"),
            std::string::npos);
  EXPECT_NE(reason([](StepBuilder& b) {
              return b.entity(fmt::format("CURVE_BOUNDED_SURFACE('',#{},(),.T.)", cylinder(b)));
            }).find("unbounded"),
            std::string::npos);
  EXPECT_NE(reason([](StepBuilder& b) {
              return b.entity(fmt::format("CURVE_BOUNDED_SURFACE('',#{},(),.F.)", cylinder(b)));
            }).find("no boundaries"),
            std::string::npos);
}

}  // namespace
}  // namespace knead
