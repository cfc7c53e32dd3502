// New STEP and IGES files of surfaces that do not come from one.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/new_surfaces.hpp"
#include "exchange/step/colours.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/format.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::new_surfaces;
using testing::open_or_die;

std::vector<NamedSurface> named(const std::vector<step::NewSurface>& surfaces) {
  std::vector<NamedSurface> result;
  for (const auto& s : surfaces) result.push_back({s.name, s.surface});
  return result;
}

/// Six sides of a box, each turned as it comes.
std::vector<NamedSurface> box() {
  std::vector<NamedSurface> result;
  const auto line = *KnotVector::clamped_uniform(1, 2);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double height : {0.0, 10.0 * (axis + 1)}) {
      Points points(4, 3);
      for (int k = 0; k < 4; ++k) {
        Point p = Point::Zero();
        p[axis] = height;
        p[(axis + 1) % 3] = (k / 2) * 10.0 * ((axis + 1) % 3 + 1);
        p[(axis + 2) % 3] = (k % 2) * 10.0 * ((axis + 2) % 3 + 1);
        points.row(k) = p.transpose();
      }
      result.push_back({"side", testing::make_surface(line, line, points)});
    }
  }
  return result;
}

std::string saved(const std::vector<NamedSurface>& surfaces, const char* format,
                  const SaveOptions& how) {
  const auto bytes = save_surfaces(surfaces, *find_format(format), how);
  EXPECT_TRUE(bytes) << bytes.error().message();
  return bytes.value_or("");
}

void expect_same(const Source& source, const std::vector<NamedSurface>& surfaces) {
  EXPECT_TRUE(source.unreadable().empty());
  ASSERT_EQ(source.surfaces().size(), surfaces.size());
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const Surface &read = *source.surfaces()[k].surface, &wanted = surfaces[k].surface;
    EXPECT_EQ(source.surfaces()[k].unit, "cm");
    EXPECT_EQ(read.knots(), wanted.knots());
    EXPECT_TRUE(testing::same_bits(read.control_points(), wanted.control_points()));
    // IGES has weights always: equal ones are none.
    const auto weights = wanted.weights();
    const bool equal = std::ranges::all_of(weights, [&](double w) { return w == weights.front(); });
    EXPECT_TRUE(std::ranges::equal(read.weights(), weights) || (equal && !read.rational()));
  }
}

TEST(NewFiles, ReadBackToTheSameBits) {
  const auto surfaces = named(new_surfaces());
  for (const char* format : {"step", "iges"}) {
    for (const bool faces : {false, true}) {
      for (const std::string_view schema : {"ap214", "ap242"}) {
        SCOPED_TRACE(std::string(format) + (faces ? " faces " : " ") + std::string(schema));
        SaveOptions how;
        how.unit = "cm";
        how.faces = faces;
        how.schema = schema;
        const auto source = open_or_die(saved(surfaces, format, how), "new");
        expect_same(*source, surfaces);
        for (const brep::SplineSurface& s : source->model()->surfaces) {
          EXPECT_EQ(s.faces, faces ? 1 : 0) << s.name;
          EXPECT_FALSE(s.trimmed) << s.name;
        }
      }
    }
  }
}

TEST(NewFiles, TheSchemaIsTheOneAskedFor) {
  SaveOptions how;
  how.schema = "ap242";
  EXPECT_NE(saved(box(), "step", how)
                .find("FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"),
            std::string::npos);
  how.schema = "ap209";
  const auto none = save_surfaces(box(), *find_format("step"), how);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("use ap214 or ap242"), std::string::npos);
}

TEST(NewFiles, SidesThatMeetShareTheirEdge) {
  for (const char* format : {"step", "iges"}) {
    SaveOptions how;
    how.faces = true;
    const std::string text = saved(box(), format, how);
    const auto source = open_or_die(text, "box");
    const auto model = model_faces(*source->model());
    ASSERT_TRUE(model) << model.error().message();
    EXPECT_EQ(model->faces.size(), 6U);
    EXPECT_TRUE(model->skipped.empty());
    if (std::string_view(format) != "step") continue;
    const auto count = [&](std::string_view word) {
      std::size_t found = 0;
      for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++found;
      return found;
    };
    EXPECT_EQ(count("=VERTEX_POINT("), 8U);
    EXPECT_EQ(count("=EDGE_CURVE("), 12U);
    EXPECT_EQ(count("=CLOSED_SHELL("), 1U);
    EXPECT_EQ(open_sides(model->faces), 0U) << "faces are turned the same way";
  }
}

TEST(NewFiles, APoleHasNoEdgeAndASeamHasOne) {
  SaveOptions how;
  how.faces = true;
  const auto all = named(new_surfaces());
  const auto cone = std::ranges::find(all, std::string("cone"), &NamedSurface::name);
  const std::string text = saved({*cone}, "step", how);
  std::size_t edges = 0;
  for (std::size_t at = text.find("=EDGE_CURVE("); at != std::string::npos;
       at = text.find("=EDGE_CURVE(", at + 1)) {
    ++edges;
  }
  EXPECT_EQ(edges, 2U) << "the base and the seam";
}

TEST(NewFiles, HaveTheColoursOfTheirSurfaces) {
  auto surfaces = box();
  surfaces[0].colour = Colour{1, 0.5, 0.25};
  surfaces[3].colour = Colour{0, 0, 1};
  SaveOptions how;
  how.faces = true;
  const auto source = open_or_die(saved(surfaces, "step", how), "box.step");
  const auto colours = source->colours();
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const auto found = colours.find(source->surfaces()[k].id);
    EXPECT_EQ(found != colours.end(), surfaces[k].colour.has_value());
    if (found != colours.end()) {
      EXPECT_EQ(found->second, *surfaces[k].colour);
    }
  }
  const std::string iges = saved(surfaces, "iges", how);
  EXPECT_NE(iges.find("314,1.0000000000000000E+02,5.0000000000000000E+01,"), std::string::npos)
      << iges;
}

TEST(NewFiles, OfIgesHaveEightyColumnsAndRightCounts) {
  auto surfaces = box();
  surfaces[1].name = "a name that is longer than a label, \xC3\xA4h";
  SaveOptions how;
  how.faces = true;
  how.title = "a box";
  const std::string text = saved(surfaces, "iges", how);
  std::map<char, int> counts;
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_EQ(line.size(), 80U) << line;
    EXPECT_EQ(std::stoi(line.substr(73)), ++counts[line[72]]) << line;
    last = line;
  }
  EXPECT_EQ(last.substr(0, 32), fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}", counts['S'], counts['G'],
                                            counts['D'], counts['P']));
  EXPECT_NE(text.find("38Ha name that is longer than a label, ?h"), std::string::npos) << text;
}

TEST(NewFiles, CurvesStandBesideFaces) {
  SaveOptions how;
  how.faces = true;
  const auto knots = *KnotVector::clamped_uniform(2, 4);
  how.curves.push_back({"wire", *Curve::create({knots}, Points::Random(4, 3))});
  for (const char* format : {"step", "iges"}) {
    const auto source = open_or_die(saved(box(), format, how), "box");
    EXPECT_EQ(source->surfaces().size(), 6U);
    if (std::string_view(format) == "step") {
      ASSERT_EQ(source->curves().size(), 1U);
      EXPECT_EQ(source->curves()[0].name, "wire");
    }
  }
}

}  // namespace
}  // namespace knead
