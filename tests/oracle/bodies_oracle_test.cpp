// The solids of every STEP, IGES and .brep file as triangles: closed, with the volume, the area and
// the box that Open CASCADE finds of the exact faces. Closed meshes without solids are held against
// its faces sewn together; of what is open, area and box. The rows of the table in
// docs/exchange.md, "Solids by mesh".

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <numeric>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/length_units.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/brep/model.hpp"
#include "knead/exchange/file_io.hpp"
#include "oracle/body_files.hpp"
#include "oracle/occt_bodies.hpp"
#include "oracle/occt_places.hpp"
#include "oracle/occt_shapes.hpp"
#include "support/long_run.hpp"
#include "support/made_iges_solids.hpp"

namespace knead::oracle {
namespace {

// Of the diagonal of the box: the tolerance that `model_faces` takes by itself.
constexpr double share = 1.0 / 2000;
constexpr double chords_share = 0.01;  // of an area: chords that turn by half a radian take as much

/// Triangles together, lengths in mm.
struct Body {
  double area = 0, volume = 0;
  std::size_t open = 0;
  Eigen::AlignedBox3d box = {};
};

Body measured(std::span<const FaceMesh> faces, double unit) {
  Body result{.volume = testing::volume_of(faces) * std::pow(unit, 3), .open = open_sides(faces)};
  for (const FaceMesh& mesh : faces) {
    result.area += testing::area_of(mesh) * unit * unit;
    for (const Point& p : mesh.points) result.box.extend(unit * p);
  }
  return result;
}

/// The faces of each part in each of its places. A face comes once for each of them, in their
/// order.
std::vector<std::vector<FaceMesh>> by_place(std::span<const FaceMesh> faces,
                                            const brep::Assembly& assembly) {
  std::map<std::string, std::vector<std::size_t>> places;  // of each face
  std::size_t count = 0;
  for (const brep::Part& part : assembly.parts) {
    for (std::size_t k = 0; k < part.places.size(); ++k, ++count) {
      for (const std::string& face : part.faces) places[face].push_back(count);
      for (const std::string& surface : part.surfaces) places[surface].push_back(count);
    }
  }
  std::vector<std::vector<FaceMesh>> result(count);
  std::map<std::string, std::size_t> met;
  for (const FaceMesh& mesh : faces) result[places.at(mesh.id).at(met[mesh.id]++)].push_back(mesh);
  return result;
}

/// Faces that share sides of triangles.
std::vector<std::vector<FaceMesh>> connected(std::span<const FaceMesh> faces) {
  std::vector<std::size_t> root(faces.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::size_t k) {
    while (root[k] != k) k = root[k] = root[root[k]];
    return k;
  };
  std::map<std::array<double, 6>, std::size_t> sides;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const auto& t : faces[f].triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Point &a = faces[f].points[t[k]], &b = faces[f].points[t[(k + 1) % 3]];
        sides.emplace(std::array{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}, f);
        const auto other = sides.find({b.x(), b.y(), b.z(), a.x(), a.y(), a.z()});
        if (other != sides.end()) root[find(f)] = find(other->second);
      }
    }
  }
  std::map<std::size_t, std::vector<FaceMesh>> parts;
  for (std::size_t f = 0; f < faces.size(); ++f) parts[find(f)].push_back(faces[f]);
  std::vector<std::vector<FaceMesh>> result;
  for (auto& [first, part] : parts) result.push_back(std::move(part));
  return result;
}

double between(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return std::max((a.min() - b.min()).cwiseAbs().maxCoeff(),
                  (a.max() - b.max()).cwiseAbs().maxCoeff());
}

class Bodies : public BodyFile {
 protected:
  void SetUp() override {
    BodyFile::SetUp();
    if (ended()) return;
    const brep::Model& file = *source_->model();
    auto model = model_faces(file);
    if (!model && model.error().what.find("no faces") != std::string::npos)
      GTEST_SKIP() << "it has no faces";
    ASSERT_TRUE(model) << model.error().message();
    model_ = *std::move(model);
    const auto& assembly = file.assembly;
    ASSERT_TRUE(assembly) << assembly.error().message();
    assembly_ = *assembly;
    other_ = occt_bodies(path_);
    ASSERT_TRUE(other_);
    if (const auto* known = length_unit_named(assembly_.unit)) unit_ = known->millimetres;
    tolerance_ = share * other_->whole.box.diagonal().norm();
  }

  void compare(std::span<const OcctBody> shells);
  void write_row(const Body& whole, bool sewn) const;

  FaceMeshes model_;
  brep::Assembly assembly_;
  std::optional<OcctBodies> other_;
  double unit_ = 1, tolerance_ = 0, volume_ = 0, volume_off_ = 0, area_off_ = 0,
         box_off_ = 0;  // mm; relative
};

/// Each shell of a solid with the faces whose box is most like its own.
void Bodies::compare(std::span<const OcctBody> shells) {
  std::vector<Body> bodies;
  for (const auto& place : by_place(model_.faces, assembly_)) {
    for (const auto& part : connected(place)) bodies.push_back(measured(part, unit_));
  }
  ASSERT_GE(bodies.size(), shells.size());
  for (const OcctBody& shell : shells) {
    const auto body = std::ranges::min_element(bodies, {}, [&](const Body& b) {
      return between(b.box, shell.box) + (b.volume * shell.volume < 0 ? tolerance_ : 0);
    });
    const double allowed = tolerance_ * body->area, off = std::abs(body->volume - shell.volume);
    EXPECT_LE(off, allowed) << body->volume << " for " << shell.volume;
    EXPECT_GT(body->volume * shell.volume, 0) << body->volume << " for " << shell.volume;
    EXPECT_NEAR(body->area, shell.area, chords_share * shell.area);
    EXPECT_LE(between(body->box, shell.box), tolerance_);
    EXPECT_EQ(body->open, 0U);
    volume_ += body->volume;
    volume_off_ = std::max(volume_off_, off / allowed);
    area_off_ = std::max(area_off_, std::abs(body->area / shell.area - 1));
    box_off_ = std::max(box_off_, between(body->box, shell.box) / tolerance_);
    bodies.erase(body);
  }
}

/// Two digits; what is below half a percent of what is allowed, as 0.
std::string share_of(double value) { return value < 0.005 ? "0" : fmt::format("{:.2g}", value); }

/// Made files have no rows on the page.
void Bodies::write_row(const Body& whole, bool sewn) const {
  double volume = 0;
  const auto& shells = sewn ? other_->sewn : other_->shells;
  for (const OcctBody& shell : shells) volume += shell.volume;
  const auto of_solids = [&](const std::string& text) {
    return shells.empty() ? std::string() : text;
  };
  const std::string row = fmt::format(
      "| {} | {} | {} | {} | {} | {:.6g} | {} % | {} | {} | {} |", GetParam(),
      sewn ? fmt::format("{} sewn", shells.size()) : std::to_string(other_->solids),
      of_solids(fmt::format("{:.6g}", volume)), of_solids(fmt::format("{:.6g}", volume_)),
      of_solids(share_of(volume_off_)), other_->whole.area, share_of(100 * area_off_),
      share_of(box_off_), whole.open, model_.skipped.size());
  std::cout << row << "\n";
  const char* path = std::getenv("KNEAD_SOLIDS_TABLE");
  if (path != nullptr && !testing::file_makers().contains(GetParam()))
    std::ofstream(path, std::ios::app) << row << "\n";
}

TEST_P(Bodies, HaveTheVolumeTheAreaAndTheBoxThatOpenCascadeFinds) {
  for (const auto& [id, reason] : model_.skipped)
    ADD_FAILURE() << id << " is left out: " << reason.message();
  EXPECT_EQ(model_.faces.size(), static_cast<std::size_t>(other_->faces));
  const Body whole = measured(model_.faces, unit_);
  EXPECT_NEAR(whole.area, other_->whole.area, chords_share * other_->whole.area);
  EXPECT_LE(between(whole.box, other_->whole.box), tolerance_);
  area_off_ = std::abs(whole.area / other_->whole.area - 1);
  box_off_ = between(whole.box, other_->whole.box) / tolerance_;
  const bool sewn = other_->solids == 0 && whole.open == 0;
  compare(sewn ? other_->sewn : other_->shells);
  write_row(whole, sewn);
}

INSTANTIATE_TEST_SUITE_P(Files, Bodies,
                         ::testing::ValuesIn(files_with_bodies(std::array<std::string, 3>{
                             "hollow_box", "drilled_torus", "rounded_box"})),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
