// Six presses, two strokes and a brush, all by defaults, on faces of every STEP, IGES and .brep
// file, one and several of them selected: no edge opens, nothing goes further than asked, or the
// act is refused with a reason. Open CASCADE measures the edges. The rows of the table in
// docs/evidence/trims.md, "Acts by defaults".

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/brep_files.hpp"
#include "oracle/occt_held.hpp"
#include "oracle/press.hpp"
#include "oracle/step_oracle.hpp"
#include "session/session_state.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

constexpr std::size_t most_faces = 6;
constexpr double closed = 1e-3;  // mm: an edge that is no farther from its faces counts as closed
constexpr double relative_gap = 1e-6;  // of the size, as `save` allows
constexpr double law = 1.06;           // 5 %, and what sampling the depth leaves
constexpr int samples = 80;

/// A surface, and where it is touched.
struct Target {
  const SourceSurface* surface = nullptr;
  std::shared_ptr<const VisibleRegion> region = nullptr;  // none: the whole surface
  Eigen::Vector2d at{0.45, 0.55};
  Point place = Point::Zero(), normal = Point::Zero(), along = Point::Zero();
  double room = 0;  // from the nearest edge
};

/// What one act asked for, and what became of it.
struct Act {
  std::string name, script;
  double asked = 0;
};

double size_of(const Surface& s) {
  const Points& net = s.control_points();
  return (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
}

/// Points of a surface and its unit normals on an even grid of the domain, row by row; points are
/// nan where they are hidden, normals zero where there are none.
struct Visible {
  Points points, normals;
};

Visible visible_points(const Surface& s, const VisibleRegion* region) {
  constexpr double hidden = std::numeric_limits<double>::quiet_NaN();
  std::array<std::vector<double>, 2> at;
  for (int d = 0; d < 2; ++d) {
    const Interval domain = s.knots(d).domain();
    for (int k = 0; k < samples; ++k) {
      at[static_cast<std::size_t>(d)].push_back(domain.lower +
                                                domain.length() * (k + 0.5) / samples);
    }
  }
  const auto jet =
      evaluate_grid<2>(s, {std::span<const double>(at[0]), std::span<const double>(at[1])}, 1);
  Visible result{jet->points(), Points(samples * samples, 3)};
  for (Eigen::Index k = 0; k < result.points.rows(); ++k) {
    const Point u = jet->at({1, 0}).row(k), v = jet->at({0, 1}).row(k);
    result.normals.row(k) = u.cross(v).normalized();
    const Eigen::Index i = k / samples, j = k % samples;
    if (region == nullptr || region->faces.empty()) continue;
    if (!region->contains({(i + 0.5) / samples, (j + 0.5) / samples}))
      result.points.row(k).setConstant(hidden);
  }
  return result;
}

/// How far a ball stands in a surface: |t| of the nearer intersection x + t n of its sphere with
/// the normal in a point x inside, the longest of all samples.
double standing_in(const Visible& shape, const Point& centre, double radius) {
  double longest = 0;
  for (Eigen::Index k = 0; k < shape.points.rows(); ++k) {
    const Point d = shape.points.row(k) - centre.transpose(), n = shape.normals.row(k);
    if (!(d.norm() < radius) || !(n.norm() > 0.5)) continue;
    const double along = d.dot(n),
                 root = std::sqrt(along * along + radius * radius - d.squaredNorm());
    longest = std::max(longest, root - std::abs(along));
  }
  return longest;
}

bool has_area(const Surface& s) {
  const Visible all = visible_points(s, nullptr);
  return (all.normals.rowwise().norm().array() > 0.5).count() > samples;
}

class DefaultActs : public testing::FileTest {
 protected:
  void SetUp() override {
    const bool is_own = testing::file_makers().contains(GetParam()) || GetParam() == "bonnet.step";
    if (!is_own && !testing::long_run()) GTEST_SKIP() << "with KNEAD_LONG=1";
    KNEAD_NEEDS(path_);
    const auto bytes = read_file(path_);
    ASSERT_TRUE(bytes);
    if (bytes->find("&SCOPE") != std::string::npos) GTEST_SKIP() << "Open CASCADE aborts on &SCOPE";
    auto source = open_source(*bytes, path_.string());
    ASSERT_TRUE(source) << source.error().message();
    source_ = *std::move(source);
    before_ = OcctHeld::read(path_);
    ASSERT_TRUE(before_);
    gaps_before_ = before_->gaps();
    out_ = fs::temp_directory_path() /
           fmt::format("knead-acts-{}{}", getpid(), path_.extension().string());
    find_targets();
    if (targets_.empty()) GTEST_SKIP() << "no surface that can be pressed";
  }
  void TearDown() override { fs::remove(out_); }

  void find_targets();
  [[nodiscard]] std::string selection(std::size_t k, bool several) const;
  [[nodiscard]] std::vector<Act> acts(std::size_t k, bool several) const;
  void carry_out(const Act& act, bool several);
  void run_all(bool several);
  void write_row(bool several) const;

  std::shared_ptr<const Source> source_;
  std::optional<OcctHeld> before_;
  std::vector<double> gaps_before_;
  fs::path out_;
  std::vector<Target> targets_;
  int done_ = 0, refused_ = 0, smaller_ = 0, unmoved_ = 0;
  double gap_before_ = 0, gap_after_ = 0, motion_ = 0;
  std::map<std::string, int> reasons_;
};

/// Up to six surfaces, small nets and large, those with faces first of all.
void DefaultActs::find_targets() {
  const brep::Model& file = *source_->model();
  std::vector<const brep::SplineSurface*> all;
  for (const bool faces : {true, false}) {
    for (const brep::SplineSurface& s : file.surfaces) {
      if ((s.faces > 0) == faces) all.push_back(&s);
    }
    if (!all.empty()) break;
  }
  std::ranges::stable_sort(all, {}, [](const brep::SplineSurface* s) { return s->surface.size(); });
  const std::size_t count = std::min(all.size(), most_faces);
  for (std::size_t k = 0; k < count; ++k) {
    const brep::SplineSurface& s = *all[count == 1 ? 0 : k * (all.size() - 1) / (count - 1)];
    const auto entry = std::ranges::find(source_->surfaces(), s.id, &SourceSurface::id);
    Target target{.surface = &*entry};
    target.room = 0.2 * size_of(s.surface);
    if (const auto region = visible_region(file, s.id); s.faces > 0 && region) {
      target.region = std::make_shared<const VisibleRegion>(*region);
      if (const auto middle = visible_middle(s.surface, *region)) {
        target.at = middle->at;
        if (std::isfinite(middle->distance)) target.room = middle->distance;
      }
    }
    const auto at = parameters_of(s.surface, target.at);
    const auto jet =
        evaluate<2>(s.surface, Parameters<2>(Eigen::Map<const Parameters<2>>(at.data(), 1, 2)), 1);
    ASSERT_TRUE(jet);
    const Point u = jet->at({1, 0}).row(0), v = jet->at({0, 1}).row(0);
    target.place = jet->points().row(0);
    target.normal = u.cross(v).normalized();
    target.along = u.normalized();
    if (target.normal.allFinite() && target.normal.norm() > 0.5 && target.room > 0)
      targets_.push_back(target);
  }
}

/// The surface, and up to two more: of those that share an edge with it where there are such.
std::string DefaultActs::selection(std::size_t k, bool several) const {
  const Target& target = targets_[k];
  std::string ids = "\"" + target.surface->id + "\"";
  if (!several) return ids;
  int more = 0;
  const auto meets = [&](const SourceSurface& other) {
    if (!target.region) return true;
    const auto region = visible_region(*source_->model(), other.id);
    return region && std::ranges::any_of(target.region->edges, [&](const TrimEdge& e) {
             return std::ranges::find(region->edges, e.id, &TrimEdge::id) != region->edges.end();
           });
  };
  for (const SourceSurface& other : source_->surfaces()) {
    if (other.id == target.surface->id || !has_area(*other.surface) || !meets(other)) continue;
    ids += ",\"" + other.id + "\"";
    if (++more == 2) break;
  }
  return ids;
}

/// Of one surface its presses, a stroke for the first and the last one, a brush for the middle one.
/// Asked is what the tool stands in the shape; of a stroke, which pushes what is in its way aside,
/// and its way there.
std::vector<Act> DefaultActs::acts(std::size_t k, bool several) const {
  const Target& t = targets_[k];
  const Surface& shape = *t.surface->surface;
  const Visible shown = visible_points(shape, t.region.get());
  const double radius = (several ? 0.9 : 0.5) * t.room, deep = radius / 4;
  const std::string begin = fmt::format(
      R"({{"knead":2,"commands":[{{"do":"select","surfaces":[{}]}},)", selection(k, several));
  const std::string tool =
      fmt::format(R"({{"do":"tool","name":"ball","radius":{:.17g},"position":{}}},)", radius,
                  list_of(t.place + 2 * radius * t.normal));
  const Point pressed = t.place + (radius - deep) * t.normal,
              aside = pressed + 0.3 * radius * t.along;
  std::vector<Act> result;
  const std::size_t presses = targets_.size() < most_faces ? (most_faces + k) / targets_.size() : 1;
  for (std::size_t n = 0; n < presses; ++n) {  // fewer surfaces: deeper as well
    const double by = deep * static_cast<double>(n + 1);
    result.push_back({"press " + t.surface->id,
                      begin + tool +
                          fmt::format(R"({{"do":"move","by":{}}},{{"do":"step","count":10}}]}})",
                                      list_of(-(radius + by) * t.normal)),
                      standing_in(shown, t.place + (radius - by) * t.normal, radius)});
    result.back().asked = std::max(result.back().asked, by);
  }
  if (k == 0 || k + 1 == targets_.size()) {
    result.push_back(
        {"stroke " + t.surface->id,
         begin + tool +
             fmt::format(R"({{"do":"stroke","path":[{},{}]}}]}})", list_of(pressed),
                         list_of(aside)),
         std::max(deep, standing_in(shown, aside, radius)) + (aside - pressed).norm()});
    if (targets_.size() == 1) result.push_back(result.back());
  }
  if (k == targets_.size() / 2) {
    result.push_back(
        {"brush " + t.surface->id,
         begin + fmt::format(R"({{"do":"brush","kind":"push","radius":{:.17g},"height":{:.17g},)"
                             R"("path":[[{:.17g},{:.17g}]]}}]}})",
                             radius, deep, t.at.x(), t.at.y()),
         deep});
  }
  return result;
}

void DefaultActs::carry_out(const Act& act, bool several) {
  SCOPED_TRACE(act.name + (several ? ", several: " : ": ") + act.script);
  Session session(Document::from(source_));
  const auto bytes = carried_out(session, act.script);
  if (!bytes) {
    ++refused_;
    ++reasons_[bytes.error().message()];
    EXPECT_FALSE(bytes.error().remedy.empty()) << bytes.error().message();
    return;
  }
  ++done_;
  const SessionState& state = session.state();
  const auto less = [](const std::string& n) {
    return n.starts_with("made smaller") || n.contains("as more would fold a face");
  };
  smaller_ += std::ranges::any_of(state.notes, less) ||
                      std::ranges::any_of(state.steps,
                                          [&](const StepRecord& step) { return less(step.note); })
                  ? 1
                  : 0;
  double moved = 0, size = 0;
  for (const SceneSurface& s : state.surfaces) {
    size = std::max(size, size_of(*s.opened));
    if (s.opened == s.current) continue;
    const auto region = visible_region(*source_->model(), s.id);
    const Points was = visible_points(*s.opened, region ? &*region : nullptr).points;
    const Points is = visible_points(*s.current, region ? &*region : nullptr).points;
    for (Eigen::Index k = 0; k < was.rows(); ++k) {
      const double way = (is.row(k) - was.row(k)).norm();
      if (way > moved) moved = way;  // nan: hidden
    }
  }
  unmoved_ += moved == 0 ? 1 : 0;
  motion_ = std::max(motion_, moved / act.asked);
  EXPECT_LE(moved, law * act.asked);
  ASSERT_TRUE(write_file_atomically(out_, *bytes));
  const auto after = OcctHeld::read(out_);
  ASSERT_TRUE(after);
  EXPECT_LE(after->bad_shapes(), before_->bad_shapes());
  const auto gaps = after->gaps();
  ASSERT_EQ(gaps.size(), gaps_before_.size());
  const double unit = source_->surfaces()[0].unit == "inch" ? 25.4
                      : source_->surfaces()[0].unit == "m"  ? 1000
                                                            : 1;
  double worst = 0;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    EXPECT_LE(gaps[k], std::max({closed, 1.01 * gaps_before_[k], relative_gap * size * unit}))
        << "edge " << k;
    worst = std::max(worst, gaps[k]);
  }
  gap_after_ = std::max(gap_after_, worst);
}

void DefaultActs::write_row(bool several) const {
  for (const auto& [reason, count] : reasons_) {
    std::cout << "refused " << count << ": " << reason << "\n";
  }
  const std::string row = fmt::format("| {} | {} | {} | {} | {} | {:.2g} → {:.2g} | {:.2f} |",
                                      GetParam(), several ? "several" : "one", done_, smaller_,
                                      refused_, gap_before_, gap_after_, motion_);
  std::cout << row << "\n";
  if (const char* path = std::getenv("KNEAD_ACTS_TABLE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

void DefaultActs::run_all(bool several) {
  for (const double gap : gaps_before_) gap_before_ = std::max(gap_before_, gap);
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    for (const Act& act : acts(k, several)) carry_out(act, several);
  }
  write_row(several);
}

TEST_P(DefaultActs, KeepTheirPromisesOnOneFace) { run_all(false); }

TEST_P(DefaultActs, KeepTheirPromisesOnSeveralFaces) { run_all(true); }

INSTANTIATE_TEST_SUITE_P(Files, DefaultActs,
                         ::testing::ValuesIn(testing::with_own(
                             testing::with_own(testing::step_files(), testing::iges_files()),
                             brep_files())),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
