#include <fmt/format.h>

#include <functional>
#include <random>

#include "exchange/brep_square.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::foreign_cad;
using testing::open_or_die;
using testing::same_bits;

/// Numbers of a surface in the order that these formats have: u fast.
std::string listed(const Surface& s, const std::function<std::string(Eigen::Index)>& point) {
  std::string text;
  for (int j = 0; j < s.net()[1]; ++j) {
    for (int i = 0; i < s.net()[0]; ++i) text += point(i * s.net()[1] + j) + "\n";
  }
  return text;
}

double weight(const Surface& s, Eigen::Index k) {
  return s.rational() ? s.weights()[static_cast<std::size_t>(k)] : 1;
}

std::string homogeneous(const Surface& s, Eigen::Index k) {
  const Point p = s.control_points().row(k).transpose() * weight(s, k);
  return fmt::format("{} {} {}", p.x(), p.y(), p.z());
}

std::string knots_of(const Surface& s, int d) {
  return fmt::format("{}", fmt::join(s.knots(d).knots(), " "));
}

std::string g2_text(const Surface& s) {
  std::string text = fmt::format("200 1 0 4 255 0 0 255\n3 {}\n", s.rational() ? 1 : 0);
  for (int d = 0; d < 2; ++d) {
    text += fmt::format("{} {}\n{}\n", s.knots(d).count(), s.knots(d).degree() + 1, knots_of(s, d));
  }
  return text + listed(s, [&](Eigen::Index k) {
           return homogeneous(s, k) + (s.rational() ? fmt::format(" {}", weight(s, k)) : "");
         });
}

/// A curve and a volume around two surfaces.
std::string g2_file(const Surface& s) {
  return "100 1 0 0\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 2 3\n\n" + g2_text(s) +
         "\n700 1 0 0\n1 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n1 2 3 4 5 6 7 8\n" +
         g2_text(s) + "\n";
}

std::string gismo_file(const Surface& s) {
  std::string basis = "<Basis type=\"TensorBSplineBasis2\">\n";
  for (int d = 0; d < 2; ++d) {
    basis += fmt::format(
        "<Basis type=\"BSplineBasis\" index=\"{}\"><KnotVector degree='{}'>{} "
        "</KnotVector></Basis>\n",
        d, s.knots(d).degree(), knots_of(s, d));
  }
  basis += "</Basis>\n";
  if (s.rational()) {
    basis = "<Basis type=\"TensorNurbsBasis2\">" + basis + "<weights>" +
            listed(s, [&](Eigen::Index k) { return fmt::format("{}", weight(s, k)); }) +
            "</weights></Basis>";
  }
  const auto point = [&](Eigen::Index k) {
    const auto p = s.control_points().row(k);
    return fmt::format("{} {} {}", p[0], p[1], p[2]);
  };
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- <Geometry type=\"TensorBSpline2\"> is not one -->\n<xml>\n"
      "<Geometry type=\"BSpline\" id=\"7\"/>\n<Geometry type=\"{}\" id=\"3\" label=\"a > "
      "b\">\n{}<coefs "
      "geoDim=\"3\">\n{}"
      "</coefs></Geometry>\n<Matrix>1 2 3</Matrix>\n</xml>\n",
      s.rational() ? "TensorNurbs2" : "TensorBSpline2", basis, listed(s, point));
}

std::string geopdes_file(const Surface& s) {
  std::string text = "# nurbs geometry v.2.1\n# made for a test\n2 3 1 0 1\nPATCH 1 of one\n";
  text += fmt::format("{} {}\n{} {}\n{}\n# knots of v\n{}\n", s.knots(0).degree(),
                      s.knots(1).degree(), s.net()[0], s.net()[1], knots_of(s, 0), knots_of(s, 1));
  for (Eigen::Index c = 0; c < 3; ++c) {
    text += listed(s, [&](Eigen::Index k) {
      return fmt::format("{}", s.control_points()(k, c) * weight(s, k));
    });
  }
  return text + listed(s, [&](Eigen::Index k) { return fmt::format("{}", weight(s, k)); }) +
         "SUBDOMAIN 1\n1\n";
}

std::string smesh_file(const Surface& s) {
  return fmt::format("3\n{} {}\n{} {}\n{}\n{}\n{}1 tv\n", s.knots(0).degree(), s.knots(1).degree(),
                     s.net()[0], s.net()[1], knots_of(s, 0), knots_of(s, 1),
                     listed(s, [&](Eigen::Index k) { return homogeneous(s, k) + " 1"; }));
}

std::string net_file(const Surface& s) {
  std::string text = "# a net\n";
  for (Eigen::Index k = 0; k < s.size(); ++k) {
    const auto p = s.control_points().row(k);
    text += fmt::format("{}{},{},{}\n", k > 0 && k % s.net()[1] == 0 ? "\n" : "", p[0], p[1], p[2]);
  }
  return text;
}

struct Door {
  std::string name, format;
  std::string (*text)(const Surface&);
  bool rational = true, refines = true;
};

std::ostream& operator<<(std::ostream& out, const Door& door) { return out << door.name; }

const Door doors[] = {{"a.g2", "GoTools", g2_file},
                      {"a.xml", "G+Smo", gismo_file},
                      {"a.dat", "GeoPDEs and Bembel", geopdes_file},
                      {"smesh.dat", "GeoPDEs and Bembel", smesh_file, false},
                      {"a.csv", "plain net", net_file, false, false}};

KnotVector cubic(int count) { return *KnotVector::clamped_uniform(3, count); }

/// Of no symmetry, 5 × 4; weights are powers of two, so that products with them are exact.
Surface relief_of(const Door& door) {
  const Surface s = testing::relief(cubic(5), cubic(4), 5);
  if (!door.rational) return s;
  std::vector<double> weights(20, 1.0);
  weights[3] = 0.5;
  weights[11] = 4;
  return *Surface::create(s.knots(), s.control_points(), weights);
}

std::string saved(const Source& source, const Surface& first) {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SourceSurface& s : source.surfaces()) surfaces.push_back(s.surface);
  surfaces.front() = std::make_shared<const Surface>(first);
  const auto bytes = source.save(surfaces);
  EXPECT_TRUE(bytes) << bytes.error().message();
  return bytes.value_or("");
}

class SurfaceText : public ::testing::TestWithParam<Door> {};

TEST_P(SurfaceText, IsReadAsItIs) {
  const Surface s = relief_of(GetParam());
  const auto source = open_or_die(GetParam().text(s), GetParam().name);
  EXPECT_EQ(source->format(), GetParam().format);
  ASSERT_GE(source->surfaces().size(), 1U);
  EXPECT_TRUE(source->unreadable().empty());
  const SourceSurface& read = source->surfaces().front();
  EXPECT_EQ(read.unit, "unknown");
  EXPECT_TRUE(same_bits(read.surface->control_points(), s.control_points()));
  EXPECT_TRUE(std::ranges::equal(read.surface->weights(), s.weights()));
  for (int d = 0; d < 2; ++d)
    EXPECT_TRUE(std::ranges::equal(read.surface->knots(d).knots(), s.knots(d).knots()));
}

TEST_P(SurfaceText, KeepsEveryByteThatDoesNotHaveToChange) {
  const Surface s = relief_of(GetParam());
  const std::string text = GetParam().text(s);
  const auto source = open_or_die(text, GetParam().name);
  EXPECT_EQ(saved(*source, *source->surfaces()[0].surface), text);
  Points points = s.control_points();
  points(6, 2) = 1.0 / 3;
  const Surface lifted = *s.with_control_points(points);
  const std::string after = saved(*source, lifted);
  const auto first =
      static_cast<std::size_t>(std::ranges::mismatch(text, after).in1 - text.begin());
  const std::string number = fmt::format("{}", s.control_points()(6, 2)),
                    third = "0.33333333333333331";
  EXPECT_EQ(text.substr(0, first) + after.substr(first), after);
  const std::size_t begin = after.find(third);
  ASSERT_NE(begin, std::string::npos) << after;
  EXPECT_EQ(after.substr(0, begin) + number + after.substr(begin + third.size()), text)
      << "one number differs";
  EXPECT_TRUE(same_bits(
      open_or_die(after, GetParam().name)->surfaces()[0].surface->control_points(), points));
}

TEST_P(SurfaceText, IsWrittenAnewWhereItIsRefined) {
  const Surface s = relief_of(GetParam());
  const auto source = open_or_die(GetParam().text(s), GetParam().name);
  const Surface fine = *insert_knots<2>(s, {std::vector<double>{0.3, 0.7}, std::vector<double>{}});
  if (!GetParam().refines) {
    const auto bytes = source->save(std::vector{std::make_shared<const Surface>(fine)});
    ASSERT_FALSE(bytes);
    EXPECT_NE(bytes.error().remedy.find(".step"), std::string::npos);
    return;
  }
  const auto again = open_or_die(saved(*source, fine), GetParam().name);
  ASSERT_EQ(again->surfaces().size(), source->surfaces().size());
  EXPECT_EQ(again->surfaces()[0].surface->net(), fine.net());
  EXPECT_LT((again->surfaces()[0].surface->control_points() - fine.control_points())
                .cwiseAbs()
                .maxCoeff(),
            1e-15);
  EXPECT_TRUE(std::ranges::equal(again->surfaces()[0].surface->weights(), fine.weights()));
  EXPECT_EQ(again->remarks(), source->remarks());
}

TEST_P(SurfaceText, DamagedIsAnErrorOrASurface) {
  const std::string text = GetParam().text(relief_of(GetParam()));
  std::mt19937 random(3);
  for (int k = 0; k < 400; ++k) {
    std::string damaged = text;
    if (k % 4 == 0) {
      damaged.resize(random() % text.size());
    } else {
      for (int n = 0; n < 3; ++n)
        damaged[random() % text.size()] = static_cast<char>("0 9-.e\n<x\"#;"[random() % 12]);
    }
    const auto source = open_source(damaged, GetParam().name);
    if (!source) {
      EXPECT_FALSE(source.error().what.empty());
      continue;
    }
    for (const SourceSurface& s : (*source)->surfaces())
      EXPECT_TRUE(s.surface->control_points().allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Doors, SurfaceText, ::testing::ValuesIn(doors),
                         [](const ::testing::TestParamInfo<Door>& door) {
                           return testing::test_name(door.param.name);
                         });

TEST(SurfaceTextErrors, SayWhereAndWhat) {
  const auto error = [](const std::string& text, const std::string& name) {
    const auto source = open_source(text, name);
    if (!source) return source.error().message();
    return (*source)->unreadable().empty() ? std::string()
                                           : (*source)->unreadable()[0].reason.message();
  };
  EXPECT_EQ(error("200 1 0 0\n3 0\n2 2\n0 0 1 x1\n", "a.g2"),
            "a.g2:4: \"x1\" is not a number; correct it");
  EXPECT_NE(
      error("200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0 1 0 0", "a.g2").find("file ends"),
      std::string::npos);
  EXPECT_NE(error("200 1 0 0\n3 0\n900000000 2\n0 0 1 1", "a.g2").find("control points"),
            std::string::npos);
  EXPECT_NE(error("120 1 0 0\n3\n0 0 0\n", "a.g2").find("no spline surface"), std::string::npos);
  EXPECT_NE(
      error(
          "<xml>\n<Geometry type=\"TensorBSpline2\"><KnotVector degree=\"1\">0 0 1 1</KnotVector>\n"
          "<KnotVector degree=\"1\">0 0 1 1</KnotVector><coefs geoDim=\"2\">0 "
          "0</coefs></Geometry></xml>",
          "a.xml")
          .find("3 coordinates"),
      std::string::npos);
  EXPECT_NE(error("# nurbs geometry v.0.7\n3 1\n1 1 1\n", "a.dat").find("3 parameters"),
            std::string::npos);
  EXPECT_NE(error("0,0,0;1,0,1e999\n0,1,0;1,1,0\n", "a.csv").find("\"1e999\" is not a number"),
            std::string::npos);
  EXPECT_TRUE(open_source("0,0,0;1,0,1e-999\n0,1,0;1,1,0\n", "a.csv"));
  EXPECT_NE(error("0,0,0;1,0,0\n0,1,0\n", "a.csv").find("row 2 has 1"), std::string::npos);
}

/// A file of one surface with that surface's part of it, from one text up to another, twice;
/// `count`: what says how many.
std::string doubled(std::string text, const std::string& from, const std::string& to,
                    const std::string& count, const std::string& two) {
  const std::size_t begin = text.find(from), end = text.find(to, begin);
  text.insert(end, text.substr(begin, end - begin));
  return count.empty() ? text : text.replace(text.find(count), count.size(), two);
}

TEST(SurfaceTextFiles, OfSeveralSurfacesOneIsChangedAlone) {
  const Surface plain = testing::relief(cubic(5), cubic(4), 5);
  std::string gismo =
      doubled(gismo_file(plain), "<Geometry type=\"TensorBSpline2\" id=\"3\"", "<Matrix>", "", "");
  gismo.replace(gismo.rfind("id=\"3\""), 6, "id=\"4\"");
  const std::pair<std::string, std::string> files[] = {
      {"a.xml", gismo},
      {"a.dat", doubled(geopdes_file(plain), "PATCH", "SUBDOMAIN", "2 3 1", "2 3 2")},
      {"a.brep", doubled(testing::brep_square, "9 0 0 0 0 1 1", "\nTriangulations", "Surfaces 1",
                         "Surfaces 2")}};
  for (const auto& [name, text] : files) {
    const auto source = open_or_die(text, name);
    ASSERT_EQ(source->surfaces().size(), 2U) << name;
    const Surface &first = *source->surfaces()[0].surface, &second = *source->surfaces()[1].surface;
    EXPECT_NE(source->surfaces()[0].id, source->surfaces()[1].id) << name;
    EXPECT_EQ(saved(*source, first), text) << name;
    Points points = first.control_points();
    points(1, 2) += 0.25;
    const auto again = open_or_die(saved(*source, *first.with_control_points(points)), name);
    EXPECT_TRUE(same_bits(again->surfaces()[0].surface->control_points(), points)) << name;
    EXPECT_TRUE(same_bits(again->surfaces()[1].surface->control_points(), second.control_points()))
        << name;
  }
}

TEST(SurfaceTextFiles, OfOthersHaveTheirSurfaces) {
  struct Expected {
    std::string file;
    std::size_t surfaces;
    std::array<int, 2> degree, net;  // of the first
  };
  const Expected expected[] = {{"egg.xml", 1, {2, 3}, {9, 20}},
                               {"teapot.xml", 32, {3, 3}, {4, 4}},
                               {"smesh.8.dat", 1, {3, 3}, {47, 45}},
                               {"smesh.45.in.dat", 1, {3, 3}, {5, 18}},
                               {"curvesToSurfaceContinuous.brep", 1, {3, 3}, {298, 11}},
                               {"Pump_TopCover.brep", 2, {2, 9}, {3, 50}},
                               {"terrain.brep", 1, {3, 3}, {312, 323}},
                               {"wing.brep", 4, {7, 1}, {8, 2}}};
  for (const auto& [name, count, degree, net] : expected) {
    KNEAD_NEEDS(foreign_cad(name));
    const auto bytes = read_file(foreign_cad(name));
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto source = open_or_die(*bytes, name);
    EXPECT_EQ(source->surfaces().size(), count) << name;
    const Surface& s = *source->surfaces().front().surface;
    EXPECT_EQ(s.net(), net) << name;
    EXPECT_EQ((std::array{s.knots(0).degree(), s.knots(1).degree()}), degree) << name;
    EXPECT_EQ(saved(*source, s), *bytes) << name;
  }
}

// Were the points taken for weighted ones, the sections would be no circles.
TEST(SurfaceTextFiles, AnEggOfGismoIsRound) {
  KNEAD_NEEDS(foreign_cad("egg.xml"));
  const auto bytes = read_file(foreign_cad("egg.xml"));
  const auto source = open_or_die(*bytes, "egg.xml");
  const Surface& s = *source->surfaces().front().surface;
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  for (int j = 1; j < 8; ++j) {
    const double t = v.lower + v.length() * j / 8;
    const auto first = *evaluate_point<2>(s, {u.lower, t});
    const auto half = *evaluate_point<2>(s, {u.lower + u.length() / 2, t});
    const Point middle = (first + half) / 2;
    for (int i = 0; i < 16; ++i) {
      const auto p = *evaluate_point<2>(s, {u.lower + u.length() * i / 16, t});
      EXPECT_NEAR((p - middle).norm(), (first - middle).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace knead
