#include <algorithm>
#include <numbers>
#include <random>
#include <sstream>

#include "brep/tessellation/model_mesh.hpp"
#include "brep/trim_loops.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::IgesBuilder;
using testing::plate;
using testing::shell;

std::shared_ptr<const Source> open_or_die(const std::string& bytes) {
  return testing::open_or_die(bytes, "test.igs");
}

Error error_of(const std::string& bytes) {
  const auto source = open_source(bytes, "test.igs");
  EXPECT_FALSE(source);
  return source ? Error{} : source.error();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

/// The file with its first surface changed.
template <class Change>
std::string changed(const Source& source, const Change& change) {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SourceSurface& s : source.surfaces()) surfaces.push_back(s.surface);
  surfaces[0] = std::make_shared<const Surface>(change(*surfaces[0]));
  auto bytes = source.save(surfaces);
  if (!bytes) {
    ADD_FAILURE() << bytes.error().message();
    return {};
  }
  return *std::move(bytes);
}

Surface lifted(const Surface& s, int k, double height) {
  Points points = s.control_points();
  points(k, 2) = height;
  return *s.with_control_points(points);
}

TEST(Iges, ASurfaceHasUSlow) {
  IgesBuilder b;
  b.add(128, plate());
  const auto source = open_or_die(b.text());
  ASSERT_EQ(source->surfaces().size(), 1U);
  const SourceSurface& s = source->surfaces()[0];
  EXPECT_EQ(source->format(), "IGES");
  EXPECT_EQ(s.id, "#1");
  EXPECT_EQ(s.name, "PLATE");
  EXPECT_EQ(s.unit, "mm");
  EXPECT_FALSE(s.surface->rational());
  EXPECT_EQ(s.surface->net(), (std::array<int, 2>{3, 2}));
  EXPECT_EQ(Point(s.surface->control_points().row(1).transpose()), Point(0, 2, 0))
      << "the second along v";
  EXPECT_EQ(Point(s.surface->control_points().row(2).transpose()), Point(2, 0, 0));
}

TEST(Iges, WhatRealWritersDoIsRead) {
  for (const std::string eol : {"\n", "\r\n", ""}) {
    IgesBuilder b;
    b.eol = eol;
    b.global = "1H;;1H#;14HOdd; separator;5Ha#b;c;2HMe;;;;;;;;1.0D+0;3;2HCM;;;;1.D-4#";
    b.separator = ';';
    b.terminator = '#';
    std::string numbers = plate("2.5D-1");
    std::ranges::replace(numbers, ',', ';');
    b.add(406, "2;11Ha;b#c text d");  // a string with separators in it
    b.add(128, numbers, 0, 0, 1);     // the directory states too few records
    const std::string text = b.text();
    const auto source = open_or_die(text);
    ASSERT_EQ(source->surfaces().size(), 1U) << eol.size();
    EXPECT_EQ(source->surfaces()[0].surface->control_points()(5, 2), 0.25);
    EXPECT_EQ(source->surfaces()[0].unit, "cm");
    EXPECT_EQ(source->surfaces()[0].id, "#3");
    EXPECT_EQ(changed(*source, [](const Surface& s) { return s; }), text) << "nothing changes";
    const std::string after =
        changed(*source, [](const Surface& s) { return lifted(s, 3, 1.0 / 3); });
    EXPECT_EQ(open_or_die(after)->surfaces()[0].surface->control_points()(3, 2), 1.0 / 3);
    EXPECT_NE(after.find("11Ha;b#c text d"), std::string::npos);
  }
}

TEST(Iges, OnlyTheRecordsOfAChangedSurfaceChange) {
  IgesBuilder b;
  b.add(110, "0.,0.,0.,1.,0.,0.");
  b.add(128, plate(), 0, 0, 0, " of the plate");
  b.add(110, "0.,0.,0.,2.,0.,0.");
  const std::string text = b.text();
  const auto source = open_or_die(text);
  const auto before = lines_of(text),
             after = lines_of(changed(*source, [](const Surface&s) { return lifted(s, 0, 0); }));
  EXPECT_EQ(before, after);
  const std::string grown =
      changed(*source, [](const Surface& s) { return lifted(s, 3, -1.0 / 3); });
  EXPECT_NE(grown.find("-3.3333333333333331E-01"), std::string::npos) << grown;
  EXPECT_NE(grown.find("; of the plate"), std::string::npos) << grown;
  const auto lines = lines_of(grown);
  int directory = 0, parameters = 0;
  for (const std::string& line : lines) {
    ASSERT_EQ(line.size(), 80U) << line;
    directory += line[72] == 'D';
    if (line[72] == 'P') {
      EXPECT_EQ(std::stoi(line.substr(73)), ++parameters) << line;
    }
  }
  EXPECT_EQ(directory, 6);
  EXPECT_EQ(lines.back().substr(24, 8), fmt::format("P{:>7}", parameters));
  for (const std::string& line : {before[2], before[3]})
    EXPECT_NE(std::ranges::find(lines, line), lines.end());
  EXPECT_NE(grown.find("110,0.,0.,0.,2.,0.,0.;"), std::string::npos);
  const auto again = open_or_die(grown);
  EXPECT_EQ(again->surfaces()[0].surface->control_points()(3, 2), -1.0 / 3);
  EXPECT_EQ(changed(*again, [](const Surface& s) { return lifted(s, 3, -1.0 / 3); }), grown);
}

TEST(Iges, RefinedSurfacesAreWrittenWithTheirKnotsAndWeights) {
  IgesBuilder b;
  std::string rational = plate();
  rational.replace(rational.find("0,0,1,0,0"), 9, "0,0,0,0,0");
  rational.replace(rational.find("1.,1.,1.,1.,1.,1.,0.,0.,0."), 18, "1.,2.,1.,1.,0.5,1.,");
  b.add(128, rational);
  b.add(128, plate());
  const auto source = open_or_die(b.text());
  ASSERT_EQ(source->surfaces().size(), 2U);
  ASSERT_TRUE(source->surfaces()[0].surface->rational());
  EXPECT_EQ(source->surfaces()[0].surface->weights()[2], 2);
  const auto finer = [](const Surface& s) {
    auto refined = insert_knots<2>(s, {std::vector<double>{0.25, 0.3}, {}});
    EXPECT_TRUE(refined);
    return *refined;
  };
  const Surface wanted = finer(*source->surfaces()[0].surface);
  const auto again = open_or_die(changed(*source, finer));
  const Surface& s = *again->surfaces()[0].surface;
  EXPECT_EQ(s.knots(), wanted.knots());
  EXPECT_TRUE(std::ranges::equal(s.weights(), wanted.weights()));
  EXPECT_TRUE(testing::same_bits(s.control_points(), wanted.control_points()));
}

TEST(Iges, MatricesAreAppliedAndTakenBack) {
  IgesBuilder b;
  const int matrix = b.add(124, "0.,-1.,0.,10.,1.,0.,0.,20.,0.,0.,1.,30.");
  b.add(128, plate(), matrix);
  const auto source = open_or_die(b.text());
  EXPECT_EQ(Point(source->surfaces()[0].surface->control_points().row(5).transpose()),
            Point(10 - 2, 20 + 4, 30));
  const std::string text = changed(*source, [](const Surface& s) { return lifted(s, 5, 31); });
  const auto again = open_or_die(text);
  EXPECT_NEAR(again->surfaces()[0].surface->control_points()(5, 2), 31, 1e-14);
  EXPECT_NE(text.find("1.0000000000000000E+00,0.,1.,0.,1.;"), std::string::npos) << text;
}

TEST(Iges, TheMatrixOfAMatrixIsAppliedAfterIt) {
  IgesBuilder b;
  const int shift = b.add(124, "1.,0.,0.,10.,0.,1.,0.,20.,0.,0.,1.,30.");
  const int turn = b.add(124, "0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,0.", shift);
  b.add(128, plate(), turn);
  const auto source = open_or_die(b.text());
  EXPECT_EQ(Point(source->surfaces()[0].surface->control_points().row(5).transpose()),
            Point(10 - 2, 20 + 4, 30));
}

/// The plate with a hole: 144 on 128, with both kinds of boundaries.
std::string trimmed(bool in_space) {
  IgesBuilder b;
  const int surface = b.add(128, plate());
  const int arc = b.add(100, "0.,1.,1.,1.5,1.,1.5,1.");
  const int flat = b.add(100, "0.,0.25,0.5,0.375,0.5,0.375,0.5");
  const int hole = b.add(142, fmt::format("1,{},{},{},2", surface, flat, in_space ? arc : 0));
  std::vector<int> sides;
  const char* corners[] = {"0.,0.,0.", "4.,0.,0.", "4.,2.,0.", "0.,2.,0."};
  for (int k = 0; k < 4; ++k)
    sides.push_back(b.add(110, fmt::format("{},{}", corners[k], corners[(k + 1) % 4])));
  const int loop = b.add(102, fmt::format("4,{},{},{},{}", sides[0], sides[1], sides[2], sides[3]));
  const int outer = b.add(142, fmt::format("1,{},0,{},2", surface, loop));
  b.add(144, fmt::format("{},1,1,{},{}", surface, outer, hole));
  return b.text();
}

TEST(Iges, TrimmedSurfacesAreFaces) {
  for (const bool in_space : {true, false}) {
    const auto source = open_or_die(trimmed(in_space));
    const brep::Model& view = *source->model();
    ASSERT_EQ(view.surfaces.size(), 1U);
    EXPECT_TRUE(view.surfaces[0].trimmed);
    EXPECT_EQ(view.surfaces[0].faces, 1);
    const auto model = model_faces(view, 1e-3);
    ASSERT_TRUE(model) << model.error().message();
    for (const auto& [id, reason] : model->skipped) ADD_FAILURE() << id << ": " << reason.message();
    double area = 0;
    for (const FaceMesh& mesh : model->faces) {
      for (const auto& t : mesh.triangles) {
        area += (mesh.points[t[1]] - mesh.points[t[0]])
                    .cross(mesh.points[t[2]] - mesh.points[t[0]])
                    .norm() /
                2;
      }
    }
    // In parameters the hole is as wide in both directions, so that it is an ellipse on the plate.
    EXPECT_NEAR(area, 8 - std::numbers::pi * 0.5 * (in_space ? 0.5 : 0.25), 0.02);
  }
}

TEST(Iges, ABoundaryThatIsNotKnownIsSaid) {
  IgesBuilder b;
  const int surface = b.add(128, plate());
  const int spline = b.add(112, "1,1,3,1,0.,1.");
  const int boundary = b.add(142, fmt::format("1,{},0,{},2", surface, spline));
  b.add(144, fmt::format("{},1,0,{}", surface, boundary));
  const auto source = open_or_die(b.text());
  const auto trims = trim_loops(*source->model());
  ASSERT_TRUE(trims);
  ASSERT_EQ(trims->skipped.size(), 1U);
  EXPECT_NE(trims->skipped[0].reason.message().find("type 112 (parametric spline curve)"),
            std::string::npos)
      << trims->skipped[0].reason.message();
}

TEST(Iges, SaysWhatIsWrong) {
  IgesBuilder b;
  b.add(128, plate());
  const std::string text = b.text();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string result = text;
    const auto at = result.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return result.replace(at, from.size(), to);
  };
  std::string packed = text;
  packed[72] = 'C';
  EXPECT_NE(error_of(packed).message().find("compressed ASCII"), std::string::npos);
  packed[72] = 'B';
  EXPECT_NE(error_of(packed).message().find("binary"), std::string::npos);
  EXPECT_NE(error_of(with("D      2", "       2")).message().find("column 73"), std::string::npos);
  EXPECT_NE(error_of(with("     128       1", "     1x8       1")).message().find("not a number"),
            std::string::npos);

  const auto unreadable = [&](const std::string& from, const std::string& to,
                              const std::string& what) {
    const auto source = open_or_die(with(from, to));
    ASSERT_EQ(source->unreadable().size(), 1U) << from;
    EXPECT_EQ(source->unreadable()[0].id, "#1");
    EXPECT_NE(source->unreadable()[0].reason.message().find(what), std::string::npos)
        << source->unreadable()[0].reason.message();
  };
  unreadable("0.,0.,0.5,1.,1.", "0.,9.,0.5,1.,1.", "knots");
  unreadable("128,2,1,1,1", "128,9,1,1,1", "parameters are missing");
  unreadable("128,2,1,1,1", "128,2,1,9,1", "out of range");
  unreadable("0.,0.,0.5,1.,1.", "0.,z.,0.5,1.,1.", "not a number");
  unreadable("1.;", "1. ", "do not end");
}

TEST(Iges, FacesOfBRepsShareTheirEdges) {
  const auto source = open_or_die(shell());
  const brep::Model& view = *source->model();
  EXPECT_EQ(view.surfaces[0].faces, 1);
  EXPECT_FALSE(view.surfaces[0].trimmed);
  const auto model = model_faces(view, 1e-3);
  ASSERT_TRUE(model && model->skipped.empty());
}

TEST(Iges, WhatIsUsedAgainAndAgainIsLimited) {
  IgesBuilder b;
  const int surface = b.add(128, plate());
  const int line = b.add(110, "0.,0.,0.,4.,0.,0.");
  std::string pieces = "2000";
  for (int k = 0; k < 2000; ++k) pieces += fmt::format(",{}", line);
  const int loop = b.add(102, pieces);
  const int boundary = b.add(142, fmt::format("1,{},0,{},2", surface, loop));
  std::string holes;
  for (int k = 0; k < 2000; ++k) holes += fmt::format(",{}", boundary);
  b.add(144, fmt::format("{},1,2000,{}{}", surface, boundary, holes));
  const std::string text = b.text();
  const auto source = open_or_die(text);
  // Four million pieces would take 600 MB.
  std::size_t pieces_kept = 0;
  for (const brep::Face& face : source->model()->faces) {
    for (const brep::Bound& bound : face.bounds) pieces_kept += bound.edges.size();
  }
  EXPECT_LT(pieces_kept, text.size() + 10'000);
}

TEST(Iges, DamagedFilesAreErrorsOrStayAsTheyAre) {
  std::mt19937 random(7);  // NOLINT: the same files every time
  const std::string letters = "0123456789,;.-+EDHSGPT \n";
  int opened = 0;
  for (const std::string& text : {trimmed(true), trimmed(false), shell()}) {
    for (int k = 0; k < 1500; ++k) {
      std::string bytes = text;
      for (int n = 1 + static_cast<int>(random() % 4); n > 0; --n) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 6) {
          case 0:
            bytes.erase(at, 1 + random() % 90);
            break;
          case 1:
            bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 90));
            break;
          default:
            bytes[at] = letters[random() % letters.size()];
        }
        if (bytes.empty()) bytes = text;
      }
      const auto source = open_source(bytes, "test.igs");
      if (!source) continue;
      ++opened;
      std::vector<std::shared_ptr<const Surface>> same;
      for (const SourceSurface& s : (*source)->surfaces()) same.push_back(s.surface);
      EXPECT_EQ(*(*source)->save(same), bytes);
      static_cast<void>(model_faces(*(*source)->model()));
      if (same.empty()) continue;
      same[0] = std::make_shared<const Surface>(lifted(*same[0], 0, 0.125));
      const auto saved = (*source)->save(same);
      if (saved) {
        EXPECT_EQ(open_or_die(*saved)->surfaces().size(), same.size());
      }
    }
  }
  EXPECT_GT(opened, 500);
}

class IgesFile : public testing::FileTest {};

TEST_P(IgesFile, KeepsEveryByteWhereNothingChanges) {
  const auto bytes = read_file(path_);
  ASSERT_TRUE(bytes);
  const auto source = open_source(*bytes, "test.igs");
  ASSERT_TRUE(source) << source.error().message();
  EXPECT_TRUE((*source)->unreadable().empty());
  std::vector<std::shared_ptr<const Surface>> same, copies;
  for (const SourceSurface& s : (*source)->surfaces()) {
    same.push_back(s.surface);
    copies.push_back(std::make_shared<const Surface>(*s.surface));
  }
  EXPECT_EQ(*(*source)->save(same), *bytes);
  EXPECT_EQ(*(*source)->save(copies), *bytes);
}

TEST_P(IgesFile, ChangedAndRefinedSurfacesReadBack) {
  const auto source = open_source(*read_file(path_), "test.igs");
  ASSERT_TRUE(source);
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (std::size_t k = 0; k < (*source)->surfaces().size(); ++k) {
    const Surface& s = *(*source)->surfaces()[k].surface;
    Points points = s.control_points();
    points.row(points.rows() / 2) += Eigen::RowVector3d(0.1, -1.0 / 3, 1e-7);
    const Surface moved = *s.with_control_points(points);
    const auto spans = moved.knots(0).spans();
    const double middle = (moved.knots(0)[spans[0]] + moved.knots(0)[spans[0] + 1]) / 2;
    const auto finer = insert_knots<2>(moved, {std::vector<double>{middle}, {}});
    ASSERT_TRUE(finer) << finer.error().message();
    surfaces.push_back(std::make_shared<const Surface>(k % 2 == 0 ? *finer : moved));
  }
  const auto bytes = (*source)->save(surfaces);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto again = open_source(*bytes, "test.igs");
  ASSERT_TRUE(again) << again.error().message();
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    EXPECT_TRUE(testing::same_bits((*again)->surfaces()[k].surface->control_points(),
                                   surfaces[k]->control_points()));
    EXPECT_EQ((*again)->surfaces()[k].surface->knots(), surfaces[k]->knots());
  }
}

INSTANTIATE_TEST_SUITE_P(Files, IgesFile, ::testing::ValuesIn(testing::iges_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead
