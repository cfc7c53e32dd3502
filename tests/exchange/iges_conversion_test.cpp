// Planes, cylinders and the like of IGES files become B-spline surfaces.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "brep/shared_edge.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/file_info.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using testing::IgesBuilder;

constexpr double exact = 1e-14;

/// A quarter of a cylinder of radius 2 about z, from z = 0 to 3, as a surface of this type.
int quarter(IgesBuilder& b, int type) {
  if (type == 120) {
    const int axis = b.add(110, "0.,0.,0.,0.,0.,1.");
    const int line = b.add(110, "2.,0.,0.,2.,0.,3.");
    return b.add(120, fmt::format("{},{},0.,1.5707963267948966", axis, line));
  }
  if (type == 122)
    return b.add(122, fmt::format("{},2.,0.,3.", b.add(100, "0.,0.,0.,2.,0.,0.,2.")));
  const int origin = b.add(116, "0.,0.,0.,0"), z = b.add(123, "0.,0.,1."),
            x = b.add(123, "1.,0.,0.");
  return b.add(192, fmt::format("{},{},2.,{}", origin, z, x), 0, 1);
}

/// The curves round it, one behind the other.
std::vector<int> curves_round(IgesBuilder& b) {
  return {b.add(100, "0.,0.,0.,2.,0.,0.,2."), b.add(110, "0.,2.,0.,0.,2.,3."),
          b.add(100, "3.,0.,0.,2.,0.,0.,2."), b.add(110, "2.,0.,3.,2.,0.,0.")};
}

struct Trimmed {
  std::string text, surface, face;
  int boundary = 0;  ///< 142, 141 or 508
};

/// The quarter as a face of this type, with curves in its parameters.
Trimmed trimmed_quarter(int type, int face_type) {
  IgesBuilder b;
  const int surface = quarter(b, type);
  const auto curves = curves_round(b);
  const int flat = b.add(110, "0.,0.,0.,1.,0.,0.");
  Trimmed result{{}, fmt::format("#{}", surface), {}, 0};
  int face = 0;
  if (face_type == 510) {
    const int corners = b.add(502, "4,2.,0.,0.,0.,2.,0.,0.,2.,3.,2.,0.,3.", 0, 1);
    // The arc at the top runs from the last corner to the third one.
    constexpr int ends[4][2] = {{1, 2}, {2, 3}, {4, 3}, {4, 1}};
    std::string edges = "4", loop = "4";
    for (std::size_t k = 0; k < 4; ++k)
      edges += fmt::format(",{},{},{},{},{}", curves[k], corners, ends[k][0], corners, ends[k][1]);
    const int list = b.add(504, edges, 0, 1);
    for (int k = 0; k < 4; ++k)
      loop += fmt::format(",0,{},{},{},1,0,{}", list, k + 1, k == 2 ? 0 : 1, flat);
    result.boundary = b.add(508, loop, 0, 1);
    face = b.add(510, fmt::format("{},1,1,{}", surface, result.boundary), 0, 1);
  } else if (face_type == 143) {
    std::string text = fmt::format("1,2,{},4", surface);
    for (std::size_t k = 0; k < 4; ++k)
      text += fmt::format(",{},{},1,{}", curves[k], k == 2 ? 2 : 1, flat);
    result.boundary = b.add(141, text);
    face = b.add(143, fmt::format("1,{},1,{}", surface, result.boundary));
  } else {
    const int round =
        b.add(102, fmt::format("4,{},{},{},{}", curves[0], curves[1], curves[2], curves[3]));
    result.boundary = b.add(142, fmt::format("1,{},{},{},3", surface, flat, round));
    face = b.add(144, fmt::format("{},1,0,{}", surface, result.boundary));
  }
  result.face = fmt::format("#{}", face);
  result.text = b.text();
  return result;
}

Expected<std::shared_ptr<const Source>> converted(const Trimmed& t) {
  return testing::open_or_die(t.text, "quarter.igs")->with_splines({&t.surface, 1});
}

/// The text of the parameters of an entity, over all of its records.
std::string parameters_of(const std::string& file, int number) {
  std::string result;
  for (std::size_t at = 0; at + 80 <= file.size(); at += 81) {
    if (file[at + 72] == 'P' && std::stoi(file.substr(at + 64, 8)) == number)
      result += file.substr(at, 64).substr(0, file.substr(at, 64).find_last_not_of(' ') + 1);
  }
  return result;
}

TEST(IgesConversion, SurfacesKeepTheirPointsAndTheirSide) {
  for (const int type : {120, 122, 192}) {
    for (const int face : {144, 143, 510}) {
      SCOPED_TRACE(fmt::format("surface {}, face {}", type, face));
      const Trimmed quarter = trimmed_quarter(type, face);
      const auto before = testing::open_or_die(quarter.text, "quarter.igs");
      ASSERT_TRUE(before->surfaces().empty());
      ASSERT_EQ(brep::other_surfaces(*before->model()).size(), 1U);
      const auto after = converted(quarter);
      ASSERT_TRUE(after) << after.error().message();
      EXPECT_TRUE(brep::other_surfaces(*(*after)->model()).empty());
      ASSERT_EQ((*after)->surfaces().size(), 1U);
      EXPECT_EQ((*after)->surfaces()[0].id, quarter.surface);
      const Surface& s = *(*after)->surfaces()[0].surface;
      const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
      double low = 9, high = -9;
      for (int k = 0; k <= 100; ++k) {
        const double p = u.lower + u.length() * (k % 11) / 10, q = v.lower + v.length() * k / 100;
        const Point point = *evaluate_point<2>(s, {std::min(p, u.upper), std::min(q, v.upper)});
        EXPECT_NEAR(std::hypot(point.x(), point.y()), 2, 4 * exact);
        EXPECT_GE(std::min(point.x(), point.y()), -exact);
        low = std::min(low, point.z());
        high = std::max(high, point.z());
      }
      EXPECT_NEAR(low, 0, exact);
      EXPECT_NEAR(high, 3, 4 * exact);
      // A surface of revolution has its parameters the other way round: its normal looks inwards.
      const auto at = [&](double p, double q) {
        return *evaluate_point<2>(s, {u.lower + p * u.length(), v.lower + q * v.length()});
      };
      const Point middle = at(0.5, 0.5);
      const Point normal = (at(0.6, 0.5) - at(0.4, 0.5)).cross(at(0.5, 0.6) - at(0.5, 0.4));
      EXPECT_GT((type == 120 ? -1 : 1) * normal.dot(Point(middle.x(), middle.y(), 0)), 0);
    }
  }
}

TEST(IgesConversion, BoundariesReferToTheCurvesInSpaceAlone) {
  const Trimmed curve = trimmed_quarter(192, 144), boundary = trimmed_quarter(192, 143),
                loop = trimmed_quarter(192, 510);
  const auto of = [](const Trimmed& t, int number) {
    const auto after = converted(t);
    if (!after) return after.error().message();
    return parameters_of(*(*after)->save({}), number);
  };
  EXPECT_EQ(of(curve, curve.boundary), "142,1,7,0,19,2;");
  EXPECT_EQ(of(boundary, boundary.boundary), "141,0,1,7,4,9,1,0,11,1,0,13,2,0,15,1,0;");
  EXPECT_EQ(of(loop, loop.boundary), "508,4,0,21,1,1,0,0,21,2,1,0,0,21,3,0,0,0,21,4,1,0;");
}

/// The directory numbers of null entities.
std::vector<int> nulls(const std::string& file) {
  std::vector<int> result;
  for (std::size_t at = 0; at + 80 <= file.size(); at += 81) {
    const int record = std::stoi(file.substr(at + 73, 7));
    if (file[at + 72] == 'D' && record % 2 == 1 && std::stoi(file.substr(at, 8)) == 0) {
      EXPECT_EQ(parameters_of(file, record), "0;");
      result.push_back(record);
    }
  }
  return result;
}

TEST(IgesConversion, DependentPartsThatNothingRefersToBecomeNull) {
  for (const auto& [type, face, parts] :
       {std::tuple(192, 510, std::vector{1, 3, 5, 17}),
        std::tuple(192, 144, std::vector{1, 3, 5, 17}), std::tuple(120, 143, std::vector{1, 3, 15}),
        std::tuple(122, 144, std::vector{1, 13})}) {
    Trimmed quarter = trimmed_quarter(type, face);
    const auto independent = converted(quarter);
    ASSERT_TRUE(independent) << independent.error().message();
    EXPECT_EQ(nulls(*(*independent)->save({})), std::vector<int>());
    constexpr std::string_view status = "00000000D", dependent = "00010000D";
    for (std::size_t at = 0; (at = quarter.text.find(status, at)) != std::string::npos;)
      quarter.text.replace(at, status.size(), dependent);
    const auto after = converted(quarter);
    ASSERT_TRUE(after) << after.error().message();
    EXPECT_EQ(nulls(*(*after)->save({})), parts);
    EXPECT_EQ((*after)->model()->edges.size(), 4U);
    EXPECT_TRUE((*after)->left_out().empty());
  }
}

TEST(IgesConversion, EdgesKeepTheirNamesAndMeetTheSurface) {
  for (const int face : {144, 143, 510}) {
    const Trimmed quarter = trimmed_quarter(192, face);
    const auto before = testing::open_or_die(quarter.text, "quarter.igs");
    const auto after = converted(quarter);
    ASSERT_TRUE(after) << after.error().message();
    ASSERT_EQ((*after)->model()->edges.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::string& id = (*after)->model()->edges[k].id;
      EXPECT_EQ(id, before->model()->edges[k].id);
      const auto edge = SharedEdge::create(*(*after)->model(), id);
      ASSERT_TRUE(edge) << edge.error().message();
      EXPECT_LE(edge->gap(), 1e-13);
      EXPECT_TRUE((*after)->can_move_edge(id));
    }
  }
}

TEST(IgesConversion, ThePlaneOfATransformedFaceGoesBackThroughItsMatrix) {
  IgesBuilder b;
  const int matrix = b.add(124, "0.,-1.,0.,5.,1.,0.,0.,6.,0.,0.,1.,7.");
  const int plane = b.add(108, "0.,0.,2.,4.,0,0.,0.,0.,0.", matrix);
  // Where the corners (0, 0), (4, 0), (4, 2), (0, 2) of the plane z = 2 go.
  const char* corners[] = {"5.,6.,9.", "5.,10.,9.", "3.,10.,9.", "3.,6.,9."};
  std::string parts = "4";
  for (int k = 0; k < 4; ++k)
    parts += fmt::format(",{}", b.add(110, fmt::format("{},{}", corners[k], corners[(k + 1) % 4])));
  const int curve = b.add(142, fmt::format("1,{},0,{},2", plane, b.add(102, parts)));
  b.add(144, fmt::format("{},1,0,{}", plane, curve));
  const std::string id = fmt::format("#{}", plane);
  const auto after = testing::open_or_die(b.text(), "plane.igs")->with_splines({&id, 1});
  ASSERT_TRUE(after) << after.error().message();
  const Surface& s = *(*after)->surfaces()[0].surface;
  ASSERT_EQ(s.net(), (std::array{2, 2}));
  EXPECT_NEAR(s.control_points().col(0).minCoeff(), 3, 1e-13);
  EXPECT_NEAR(s.control_points().col(0).maxCoeff(), 5, 1e-13);
  EXPECT_NEAR(s.control_points().col(1).minCoeff(), 6, 1e-13);
  EXPECT_NEAR(s.control_points().col(1).maxCoeff(), 10, 1e-13);
  EXPECT_LE((s.control_points().col(2).array() - 9).abs().maxCoeff(), 1e-13);
}

TEST(IgesConversion, TheHalfAngleOfAConeIsInDegrees) {
  IgesBuilder b;
  const int origin = b.add(116, "0.,0.,0.,0"), z = b.add(123, "0.,0.,1.");
  const int cone = b.add(194, fmt::format("{},{},2.,45.", origin, z));
  const int round =
      b.add(102, fmt::format("4,{},{},{},{}", b.add(100, "0.,0.,0.,2.,0.,0.,2."),
                             b.add(110, "0.,2.,0.,0.,5.,3."), b.add(100, "3.,0.,0.,5.,0.,0.,5."),
                             b.add(110, "5.,0.,3.,2.,0.,0.")));
  b.add(144, fmt::format("{},1,0,{}", cone, b.add(142, fmt::format("1,{},0,{},2", cone, round))));
  const std::string id = fmt::format("#{}", cone);
  const auto after = testing::open_or_die(b.text(), "cone.igs")->with_splines({&id, 1});
  ASSERT_TRUE(after) << after.error().message();
  const Surface& s = *(*after)->surfaces()[0].surface;
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  for (const double p : {0.0, 0.3, 1.0}) {
    for (const double q : {0.0, 0.4, 1.0}) {
      const Point point =
          *evaluate_point<2>(s, {u.lower + p * u.length(), v.lower + q * v.length()});
      EXPECT_NEAR(std::hypot(point.x(), point.y()), 2 + point.z(), 1e-13);
      EXPECT_NEAR(point.z(), 3 * q, 1e-13);
    }
  }
}

/// An eighth of a sphere of radius 2, or of a quarter of a torus of radii 3 and 1 the outer, upper
/// quarter, as a surface of type 196 or 198 with arcs about it.
std::string eighth(int type) {
  IgesBuilder b;
  const int to_xz = b.add(124, "1.,0.,0.,0.,0.,0.,-1.,0.,0.,1.,0.,0."),
            to_yz = b.add(124, "0.,0.,1.,0.,1.,0.,0.,0.,0.,1.,0.,0.");
  const int origin = b.add(116, "0.,0.,0.,0"), z = b.add(123, "0.,0.,1."),
            x = b.add(123, "1.,0.,0.");
  std::vector<int> curves;
  int surface = 0;
  if (type == 196) {
    surface = b.add(196, fmt::format("{},2.,{},{}", origin, z, x), 0, 1);
    curves = {b.add(100, "0.,0.,0.,2.,0.,0.,2."), b.add(100, "0.,0.,0.,2.,0.,0.,2.", to_yz),
              b.add(100, "0.,0.,0.,2.,0.,0.,2.", to_xz)};
  } else {
    surface = b.add(198, fmt::format("{},{},3.,1.,{}", origin, z, x), 0, 1);
    curves = {b.add(100, "0.,0.,0.,4.,0.,0.,4."), b.add(100, "0.,3.,0.,4.,0.,3.,1.", to_yz),
              b.add(100, "1.,0.,0.,3.,0.,0.,3."), b.add(100, "0.,3.,0.,4.,0.,3.,1.", to_xz)};
  }
  std::string parts = std::to_string(curves.size());
  for (const int curve : curves) parts += fmt::format(",{}", curve);
  const int round = b.add(142, fmt::format("1,{},0,{},2", surface, b.add(102, parts)));
  b.add(144, fmt::format("{},1,0,{}", surface, round));
  return b.text();
}

TEST(IgesConversion, SpheresAndToriKeepTheirPoints) {
  for (const int type : {196, 198}) {
    SCOPED_TRACE(type);
    const auto before = testing::open_or_die(eighth(type), "round.igs");
    const auto others = brep::other_surfaces(*before->model());
    ASSERT_EQ(others.size(), 1U);
    const auto after = before->with_splines({&others[0].id, 1});
    ASSERT_TRUE(after) << after.error().message();
    ASSERT_EQ((*after)->surfaces().size(), 1U);
    const Surface& s = *(*after)->surfaces()[0].surface;
    const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
    for (int k = 0; k <= 100; ++k) {
      const double p = std::min(u.lower + u.length() * (k % 11) / 10, u.upper),
                   q = std::min(v.lower + v.length() * k / 100, v.upper);
      const Point point = *evaluate_point<2>(s, {p, q});
      const double round = std::hypot(point.x(), point.y());
      const double off = type == 196 ? point.norm() - 2 : std::hypot(round - 3, point.z()) - 1;
      EXPECT_NEAR(off, 0, 8 * exact);
    }
    for (const brep::Edge& edge : (*after)->model()->edges) {
      const auto shared = SharedEdge::create(*(*after)->model(), edge.id);
      ASSERT_TRUE(shared) << shared.error().message();
      EXPECT_LE(shared->gap(), 1e-13);
    }
  }
}

TEST(IgesConversion, RefusesWhatNeedsTheParametersOfTheSurface) {
  const auto message = [](const std::string& text, const std::string& id) {
    const auto after = testing::open_or_die(text, "part.igs")->with_splines({&id, 1});
    return after ? std::string() : after.error().message();
  };
  IgesBuilder offset;
  const int below = quarter(offset, 192);
  const auto curves = curves_round(offset);
  const int round =
      offset.add(102, fmt::format("4,{},{},{},{}", curves[0], curves[1], curves[2], curves[3]));
  const int boundary = offset.add(142, fmt::format("1,{},0,{},2", below, round));
  offset.add(144, fmt::format("{},1,0,{}", below, boundary));
  const std::string id = fmt::format("#{}", below);
  IgesBuilder open = offset;
  open.add(144, fmt::format("{},0,0,0", below));
  offset.add(140, fmt::format("1.,0.,0.,0.5,{}", below));
  const auto source = testing::open_or_die(offset.text(), "part.igs");
  const FileInfo info = file_info(*source, {.conversions = true});
  ASSERT_EQ(info.other_surfaces.size(), 1U);
  EXPECT_FALSE(info.other_surfaces[0].convertible);
  EXPECT_NE(info.other_surfaces[0].reason.find("type 140"), std::string::npos);
  EXPECT_NE(message(offset.text(), id).find("type 140"), std::string::npos);
  EXPECT_NE(message(open.text(), id).find("ends where its surface does"), std::string::npos);
}

// As a B-spline surface with a loop along its seam other programs lose its face.
TEST(IgesConversion, RefusesWholeSpheres) {
  IgesBuilder b;
  const int to_xz = b.add(124, "1.,0.,0.,0.,0.,0.,-1.,0.,0.,1.,0.,0.");
  const int origin = b.add(116, "0.,0.,0.,0"), z = b.add(123, "0.,0.,1."),
            x = b.add(123, "1.,0.,0.");
  const int sphere = b.add(196, fmt::format("{},2.,{},{}", origin, z, x), 0, 1);
  const int seam = b.add(100, "0.,0.,0.,0.,-2.,0.,2.", to_xz);
  const int poles = b.add(502, "2,0.,0.,-2.,0.,0.,2.", 0, 1);
  const int list = b.add(504, fmt::format("1,{},{},1,{},2", seam, poles, poles), 0, 1);
  const int loop = b.add(508, fmt::format("2,0,{},1,1,0,0,{},1,0,0", list, list), 0, 1);
  b.add(510, fmt::format("{},1,1,{}", sphere, loop), 0, 1);
  const auto before = testing::open_or_die(b.text(), "sphere.igs");
  ASSERT_EQ(brep::other_surfaces(*before->model()).size(), 1U);
  const std::string id = fmt::format("#{}", sphere);
  const auto after = before->with_splines({&id, 1});
  ASSERT_FALSE(after);
  EXPECT_NE(after.error().message().find("whole spheres"), std::string::npos)
      << after.error().message();
}

TEST(IgesConversion, InfoSaysWhatIsConvertible) {
  const Trimmed quarter = trimmed_quarter(192, 510);
  const auto source = testing::open_or_die(quarter.text, "quarter.igs");
  const FileInfo info = file_info(*source, {.faces = true});
  ASSERT_EQ(info.other_surfaces.size(), 1U);
  EXPECT_EQ(info.other_surfaces[0].convertible, true) << info.other_surfaces[0].reason;
}

}  // namespace
}  // namespace knead
