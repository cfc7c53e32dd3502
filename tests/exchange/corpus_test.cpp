// The statements about reading and writing, over every STEP file there is.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "exchange/part21/part21.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/long_run.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::same_bits;

class Corpus : public testing::FileTest {};

// Points of a surface moved: all, or one, or one row, each by its own vector.
Points moved(const Surface& surface, const std::string& pattern) {
  Points points = surface.control_points();
  const double size =
      1e-3 * std::max(1e-6, (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm());
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const bool moves = pattern == "all" || (pattern == "one" && k == points.rows() / 2) ||
                       (pattern == "row" && k / surface.net()[1] == surface.net()[0] - 1);
    if (!moves) continue;
    points(k, 2) += size * (1 + std::sin(static_cast<double>(k)) / 3);
    if (k % 3 == 0) points(k, 0) -= size / 7;
  }
  return points;
}

// What of a record is not a number and not a reference.
std::string skeleton(const Part21File& file, const Part21Instance& instance) {
  std::string text;
  std::uint32_t at = instance.bytes.begin;
  for (auto k = instance.first; k < instance.last; ++k) {
    const auto kind = file.value(k).kind;
    if (kind != Part21Kind::real && kind != Part21Kind::integer && kind != Part21Kind::reference)
      continue;
    text += file.text(ByteRange{at, file.range(k).begin});
    at = file.range(k).end;
  }
  return text + std::string(file.text(ByteRange{at, instance.bytes.end}));
}

// Everything in `after` that differs from `before`, held against what may differ: numbers and
// references in records of edited surfaces (anything where they were refined), numbers in points
// that only these use.
void expect_only_surfaces_differ(const step::File& before, const std::string& after,
                                 const std::set<std::string>& edited, bool refined = false) {
  const auto a = *Part21File::parse(before.bytes(), "before");
  const auto b = *Part21File::parse(after, "after");
  std::set<std::uint64_t> surfaces;
  std::map<std::uint64_t, std::uint32_t>
      uses_of_points;  // control points of edited surfaces, and how often these use them
  for (const auto& id : edited) {
    const auto name = std::stoull(id.substr(1));
    surfaces.insert(name);
    const auto& record = a.instance(*a.find(name));
    for (auto k = record.first; k < record.last; ++k) {
      if (a.value(k).kind == Part21Kind::reference)
        ++uses_of_points[a.instance(a.value(k).target).id];
    }
  }
  std::uint32_t end_a = 0;
  std::uint32_t end_b = 0;
  std::size_t next = 0;
  for (const auto& record : a.instances()) {
    ASSERT_LT(next, b.instances().size());
    const auto* other = &b.instances()[next++];
    EXPECT_EQ(a.text(ByteRange{end_a, record.bytes.begin}),
              b.text(ByteRange{end_b, other->bytes.begin}))
        << "before #" << record.id;
    ASSERT_EQ(record.id, other->id);
    end_a = record.bytes.end;
    end_b = other->bytes.end;
    if (a.text(record.bytes) != b.text(other->bytes)) {
      const bool surface = surfaces.contains(record.id);
      const bool point =
          uses_of_points.contains(record.id) && uses_of_points[record.id] == record.uses;
      EXPECT_TRUE(surface || point) << a.text(record.bytes) << " became " << b.text(other->bytes);
      if (!refined || !surface) {
        EXPECT_EQ(skeleton(a, record), skeleton(b, *other));
      }
    }
    // New records stand behind the surface they belong to.
    while (surfaces.contains(record.id) && next < b.instances().size() &&
           b.instances()[next].id > a.largest_id()) {
      const auto& added = b.instances()[next++];
      EXPECT_EQ(b.keyword(added.first), "CARTESIAN_POINT");
      EXPECT_GE(added.uses, 1U);
      EXPECT_TRUE(b.text(ByteRange{end_b, added.bytes.begin}).find_first_not_of("\r\n") ==
                  std::string_view::npos);
      end_b = added.bytes.end;
    }
  }
  EXPECT_EQ(next, b.instances().size());
  EXPECT_EQ(a.bytes().substr(end_a), b.bytes().substr(end_b));
}

void edit_and_compare(const step::File& file, const std::vector<std::size_t>& which,
                      const std::string& pattern) {
  std::vector<step::Edit> edits;
  std::set<std::string> ids;
  for (const auto k : which) {
    edits.push_back({file.surfaces()[k].id, moved(file.surfaces()[k].surface, pattern)});
    ids.insert(file.surfaces()[k].id);
  }
  const auto written = file.with_control_points(edits);
  ASSERT_TRUE(written) << written.error().message();
  expect_only_surfaces_differ(file, *written, ids);
  const auto again = step::File::parse(*written, "again");
  ASSERT_TRUE(again) << again.error().message();
  ASSERT_EQ(again->surfaces().size(), file.surfaces().size());
  std::size_t e = 0;
  for (std::size_t k = 0; k < file.surfaces().size(); ++k) {
    const auto& old = file.surfaces()[k];
    const auto& now = again->surfaces()[k];
    const bool is_edited = e < which.size() && which[e] == k;
    const auto& expected = is_edited ? edits[e++].control_points : old.surface.control_points();
    EXPECT_TRUE(same_bits(now.surface.control_points(), expected)) << old.id << " " << pattern;
    EXPECT_EQ(now.surface.knots(), old.surface.knots());
    EXPECT_TRUE(std::ranges::equal(now.surface.weights(), old.surface.weights()));
    EXPECT_EQ(now.name, old.name);
    EXPECT_EQ(now.unit, old.unit);
  }
  EXPECT_EQ(again->model().instances.size(), file.model().instances.size());
}

TEST_P(Corpus, WithoutEditsComesBackByteForByte) {
  const auto bytes = read_file(path_);
  ASSERT_TRUE(bytes);
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_EQ(file->bytes(), *bytes);
  EXPECT_EQ(file->with_control_points({}), *bytes);
  std::vector<step::Edit> same;
  for (const auto& surface : file->surfaces())
    same.push_back({surface.id, surface.surface.control_points()});
  EXPECT_EQ(file->with_control_points(same), *bytes);
}

TEST_P(Corpus, AllSurfacesMovedReadBackExactly) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file) << file.error().message();
  std::vector<std::size_t> all(file->surfaces().size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  for (const auto* pattern : {"all", "row", "one"}) edit_and_compare(*file, all, pattern);
}

TEST_P(Corpus, SingleSurfacesMovedReadBackExactly) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file) << file.error().message();
  const auto count = file->surfaces().size();
  const std::size_t most = testing::long_run() ? count : 3;
  for (std::size_t k = 0; k < std::min(most, count); ++k)
    edit_and_compare(*file, {k * count / std::min(most, count)}, "all");
}

TEST_P(Corpus, AllSurfacesRefinedReadBackExactly) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file) << file.error().message();
  std::vector<brep::Replacement> refined;
  std::set<std::string> ids;
  for (const auto& surface : file->surfaces()) {
    // One knot in the first span of u, all spans of v halved, one degree more along u.
    const auto domain = surface.surface.knots(0).domain();
    const auto first = span_midpoints(surface.surface.knots(0), {domain.lower, domain.lower});
    const auto all = span_midpoints(surface.surface.knots(1), surface.surface.knots(1).domain());
    auto finer = insert_knots<2>(surface.surface, {first, all});
    ASSERT_TRUE(finer) << finer.error().message();
    if (finer->knots(0).degree() < max_degree) finer = elevate_degree(*finer, 0);
    ASSERT_TRUE(finer) << finer.error().message();
    refined.push_back({surface.id, *std::move(finer)});
    ids.insert(surface.id);
  }
  const auto written = file->with_surfaces(refined);
  ASSERT_TRUE(written) << written.error().message();
  expect_only_surfaces_differ(*file, *written, ids, true);
  const auto again = step::File::parse(*written, "again");
  ASSERT_TRUE(again) << again.error().message();
  ASSERT_EQ(again->surfaces().size(), file->surfaces().size());
  for (std::size_t k = 0; k < refined.size(); ++k) {
    const auto& old = file->surfaces()[k];
    const auto& now = again->surfaces()[k];
    EXPECT_EQ(now.id, old.id);
    EXPECT_EQ(now.surface.knots(), refined[k].surface.knots()) << old.id;
    EXPECT_TRUE(same_bits(now.surface.control_points(), refined[k].surface.control_points()))
        << old.id;
    EXPECT_TRUE(std::ranges::equal(now.surface.weights(), refined[k].surface.weights())) << old.id;
    EXPECT_EQ(now.name, old.name);
    EXPECT_EQ(now.unit, old.unit);
    EXPECT_EQ(now.closed, old.closed) << old.id;
    EXPECT_EQ(now.trimmed, old.trimmed) << old.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Step, Corpus, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

TEST(ForeignFiles, AreAllListed) {
  const std::filesystem::path folder = testing::foreign_cad("");
  KNEAD_NEEDS(testing::foreign_cad("INDEX.csv"));
  std::set<std::string> listed = {"INDEX.csv"};
  const auto list = [&listed](const auto& names) { listed.insert(names.begin(), names.end()); };
  list(testing::foreign_step);
  list(testing::foreign_iges);
  list(testing::foreign_brep);
  list(testing::foreign_text);
  list(testing::foreign_rhino);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    there.insert(entry.path().filename().string());
  EXPECT_EQ(there, listed) << "tests/support/foreign_files.hpp lists them";
}

}  // namespace
}  // namespace knead
