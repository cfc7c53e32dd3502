// Every STEP and IGES file of the collection is written unchanged, and with up to four of its faces
// pressed in their visible middle; Open CASCADE says what became of it. The rows of the table in
// docs/exchange.md: all of them with KNEAD_LONG, which KNEAD_EXCHANGE_TABLE=1 writes into the page;
// else those of small files, which must be the page's.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "oracle/exchange_table.hpp"
#include "oracle/occt_gaps.hpp"
#include "oracle/press.hpp"
#include "oracle/step_oracle.hpp"
#include "session/session_state.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

constexpr std::size_t most_pressed = 4;
constexpr double closed_gap = 1e-3;   // mm
constexpr double least_gap = 1e-6;    // mm, and
constexpr double least_angle = 1e-3;  // degrees: what the table states as less
constexpr std::array quick = {
    "bonnet.step", "test_pipe.step", "goteborg.step", "ap214_repeated_distinct_surface_knots.stp",
    "wigley.iges", "tip.iges",       "shaft.iges",    "series_60.iges"};

bool is_iges(const fs::path& path) {
  return path.extension() == ".igs" || path.extension() == ".iges";
}

/// The data of every entity of an IGES file but one, without the numbers of its lines: what an
/// editor of another entity must leave alone.
std::map<std::string, std::string> entities_of(const std::string& bytes, const std::string& but) {
  std::map<std::string, std::string> result;
  std::istringstream lines(bytes);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 73 || line[72] != 'P') continue;
    std::string number = line.substr(64, 8);
    number.erase(0, number.find_first_not_of(" 0"));
    if ("#" + number != but) result[number] += line.substr(0, 64);
  }
  return result;
}

/// What the edit of one surface lost of the rest of the file.
std::size_t lost_of(const std::string& before, const std::string& after, const std::string& surface,
                    bool iges) {
  std::size_t lost = 0;
  if (iges) {
    const auto now = entities_of(after, surface);
    for (const auto& [number, text] : entities_of(before, surface)) {
      const auto found = now.find(number);
      lost += found == now.end() || found->second != text ? 1 : 0;
    }
    return lost;
  }
  const auto now = records_of(after);
  for (const std::string& record : records_of(before)) {
    if (now.contains(record) || record.find("CARTESIAN_POINT") != std::string::npos) continue;
    std::string name = record.substr(0, record.find('='));  // comments may stand before it
    name.erase(name.find_last_not_of(" \r\n") + 1);
    const bool is_own = name.ends_with(surface);
    lost += is_own ? 0 : 1;
  }
  return lost;
}

std::string count(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

class Exchange : public testing::FileTest {
 protected:
  void SetUp() override {
    const std::string& name = GetParam();
    if (!is_made() && !testing::long_run() && std::ranges::find(quick, name) == quick.end()) {
      GTEST_SKIP() << "with KNEAD_LONG=1";
    }
    KNEAD_NEEDS(path_);
    auto source = open_source(*read_file(path_), path_.string());
    ASSERT_TRUE(source) << source.error().message();
    source_ = *std::move(source);
    directory_ = fs::temp_directory_path() / ("knead-exchange-" + std::to_string(getpid()));
    fs::create_directories(directory_);
    if ((*read_file(path_)).find("&SCOPE") != std::string::npos)
      GTEST_SKIP() << "Open CASCADE aborts on &SCOPE";
    before_ = OcctFaces::read(path_);
    ASSERT_TRUE(before_);
  }
  void TearDown() override {
    if (!directory_.empty()) fs::remove_all(directory_);
  }

  /// Made files have no rows on the page.
  [[nodiscard]] bool is_made() const { return testing::file_makers().contains(GetParam()); }
  [[nodiscard]] const brep::Model& file() const { return *source_->model(); }
  [[nodiscard]] std::vector<const brep::SplineSurface*> chosen() const;
  [[nodiscard]] std::string traits() const;
  void press_all(const std::string& held);

  std::shared_ptr<const Source> source_;
  std::optional<OcctFaces> before_;
  fs::path directory_;
};

/// Up to four surfaces with faces, the trimmed ones first of all; small nets and large.
std::vector<const brep::SplineSurface*> Exchange::chosen() const {
  std::vector<const brep::SplineSurface*> all, trimmed;
  for (const brep::SplineSurface& s : file().surfaces) {
    if (s.faces > 0) all.push_back(&s);
    if (s.faces > 0 && s.trimmed) trimmed.push_back(&s);
  }
  auto& from = trimmed.empty() ? all : trimmed;
  std::ranges::stable_sort(from, {},
                           [](const brep::SplineSurface* s) { return s->surface.size(); });
  if (from.size() <= most_pressed) return from;
  std::vector<const brep::SplineSurface*> result;
  for (std::size_t k = 0; k < most_pressed; ++k)
    result.push_back(from[k * (from.size() - 1) / (most_pressed - 1)]);
  return result;
}

std::string Exchange::traits() const {
  std::size_t rational = 0, trimmed = 0, closed = 0, faces = 0;
  int degree = 0, net = 0;
  for (const brep::SplineSurface& s : file().surfaces) {
    rational += s.surface.rational() ? 1 : 0;
    trimmed += s.trimmed ? 1 : 0;
    closed += s.closed[0] || s.closed[1] ? 1 : 0;
    faces += static_cast<std::size_t>(s.faces);
    degree = std::max({degree, s.surface.knots(0).degree(), s.surface.knots(1).degree()});
    net = std::max(net, static_cast<int>(s.surface.size()));
  }
  std::string text =
      is_iges(path_) ? "IGES" : source_->schema().substr(0, source_->schema().find(' '));
  const auto& surfaces = source_->surfaces();
  text += ", " + (surfaces.empty() ? file().length_unit() : surfaces[0].unit) + ", " +
          count(surfaces.size(), "surface", "surfaces") + " with " + count(faces, "face", "faces");
  if (rational > 0) text += ", " + std::to_string(rational) + " rational";
  if (trimmed > 0) text += ", " + std::to_string(trimmed) + " trimmed";
  if (closed > 0) text += ", " + std::to_string(closed) + " closed";
  if (!surfaces.empty())
    text += ", degree to " + std::to_string(degree) + ", net to " + std::to_string(net);
  if (!file().instances.empty()) text += ", assembly";
  return text;
}

void Exchange::press_all(const std::string& held) {
  const std::string& name = GetParam();
  std::vector<std::shared_ptr<const Surface>> same;
  for (const SourceSurface& s : source_->surfaces()) same.push_back(s.surface);
  const auto unchanged = source_->save(same);
  ASSERT_TRUE(unchanged && *unchanged == *read_file(path_)) << "zero steps";

  std::string pressed_ids, refused;
  std::size_t lost = 0, smooth = 0;
  double gap_before = 0, gap_after = 0, turn = 0, angle_before = 0, angle_after = 0;
  int bad = 0;
  bool topology = true;
  for (const brep::SplineSurface* s : chosen()) {
    SCOPED_TRACE(s->id + " " + held);
    const auto pressed = press(file(), *s, held);
    Session session(Document::from(source_));
    const auto bytes =
        pressed ? carried_out(session, pressed->script) : std::unexpected(pressed.error());
    if (!bytes) {
      std::cout << name << " " << s->id << ": " << bytes.error().message() << "\n";
      refused += (refused.empty() ? "" : ", ") + s->id;
      continue;
    }
    pressed_ids += (pressed_ids.empty() ? "" : ", ") + s->id;
    const auto path = directory_ / name;
    ASSERT_TRUE(write_file_atomically(path, *bytes));
    const auto after = OcctFaces::read(path);
    ASSERT_TRUE(after);

    EXPECT_NE(*bytes, *unchanged);
    EXPECT_EQ(before_->topology(), after->topology());
    topology = topology && before_->topology() == after->topology();
    EXPECT_LE(after->bad_faces(), before_->bad_faces());
    EXPECT_LE(after->bad_edges(), before_->bad_edges());
    bad = std::max(
        bad, after->bad_faces() + after->bad_edges() - before_->bad_faces() - before_->bad_edges());
    const std::size_t gone = lost_of(*unchanged, *bytes, s->id, is_iges(path_));
    EXPECT_EQ(gone, 0U) << "of the rest of the file";
    lost += gone;

    const auto was = before_->edges(s->id, *before_), is = before_->edges(s->id, *after);
    ASSERT_EQ(was.size(), is.size());
    EXPECT_FALSE(is.empty());
    for (std::size_t k = 0; k < is.size(); ++k) {
      EXPECT_LE(is[k].gap, std::max({closed_gap, was[k].tolerance, 1.001 * was[k].gap}))
          << "edge " << k;
      gap_before = std::max(gap_before, was[k].gap);
      gap_after = std::max(gap_after, is[k].gap);
      turn = std::max(turn, is[k].turn);
      if (held == "tangent") {
        EXPECT_LE(is[k].turn, least_angle) << "edge " << k;
      }
    }
    for (const OcctFaces::Across& edge : before_->across(s->id, *after)) {
      ++smooth;
      angle_before = std::max(angle_before, edge.before);
      angle_after = std::max(angle_after, edge.after);
      if (held == "tangent") {
        EXPECT_LE(edge.after, edge.before + least_angle);
      }
    }
    EXPECT_FALSE(before_->moved(s->id, *after).folded);
    const auto& now = session.state().surfaces[static_cast<std::size_t>(*session.state().selected)];
    const auto there = evaluate_point<2>(*now.current, pressed->at);
    ASSERT_TRUE(there);
    EXPECT_GE((*there - pressed->place).norm() / pressed->depth, 0.9)
        << "of the depth that was asked for";
  }
  std::string acts = pressed_ids.empty() ? "written unchanged" : pressed_ids;
  if (!refused.empty()) acts += "; refused: " + refused;
  const std::string key = key_of(name, held);
  std::string row = key + " " + traits() + " | " + acts + " | ";
  if (pressed_ids.empty()) {
    row += "the same bytes | | | | |";
  } else {
    row += std::string(topology ? "the same" : "another") + " | " +
           (bad <= 0 ? "none" : std::to_string(bad)) + " | " +
           (lost == 0 ? "none" : std::to_string(lost)) + " | " + figure(gap_before, least_gap) +
           " → " + figure(gap_after, least_gap) + " | " +
           (smooth == 0 ? std::string("no smooth edge")
                        : std::to_string(smooth) + ": " + figure(angle_before, least_angle) +
                              " → " + figure(angle_after, least_angle)) +
           " |";
  }
  std::cout << row << "\n";
  if (is_made()) return;
  if (std::getenv("KNEAD_EXCHANGE_TABLE") != nullptr) put_row(key, row);
  const auto stated = row_of_page(key);
  ASSERT_TRUE(stated) << "docs/exchange.md has no row for it";
  EXPECT_EQ(*stated, row) << "docs/exchange.md; scripts/exchange_table.sh writes it anew";
}

TEST_P(Exchange, HoldsTheEdgesOfPressedFaces) { press_all("position"); }

TEST_P(Exchange, HoldsTheirTangentPlanesToo) { press_all("tangent"); }

std::vector<std::string> exchange_files() {
  auto files = testing::with_own(testing::step_files(), testing::iges_files());
  std::ranges::sort(files);  // as the rows of the page are
  return files;
}
INSTANTIATE_TEST_SUITE_P(Files, Exchange, ::testing::ValuesIn(exchange_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
