#include <fmt/format.h>

#include <set>

#include "brep/moved_edge.hpp"
#include "exchange/format_list.hpp"
#include "left_out.hpp"
#include "model.hpp"
#include "moved.hpp"

namespace knead::detail {
namespace {

/// Type 9: flags, degrees, numbers of poles and knots, poles with v fast, knots with
/// multiplicities.
Expected<std::string> print_brep(const Surface& surface) {
  const auto [rows, columns] = surface.net();
  std::array<std::string, 2> knots;
  std::array<int, 2> distinct = {};
  for (int d = 0; d < 2; ++d) {
    const auto values = surface.knots(d).knots();
    for (std::size_t k = 0, next = 0; k < values.size(); k = next) {
      while (next < values.size() && values[next] == values[k]) ++next;
      knots[static_cast<std::size_t>(d)] += fmt::format("{} {}\n", shortest(values[k]), next - k);
      ++distinct[static_cast<std::size_t>(d)];
    }
  }
  const int rational = surface.rational() ? 1 : 0;
  std::string text =
      fmt::format("9 {} {} 0 0 {} {} {} {} {} {}\n", rational, rational, surface.knots(0).degree(),
                  surface.knots(1).degree(), rows, columns, distinct[0], distinct[1]);
  for (int k = 0; k < surface.size(); ++k) {
    const auto p = surface.control_points().row(k);
    text += digits_17(p[0]) + " " + digits_17(p[1]) + " " + digits_17(p[2]);
    if (rational != 0) text += " " + shortest(surface.weights()[static_cast<std::size_t>(k)]);
    text += '\n';
  }
  return text + "\n" + knots[0] + "\n" + knots[1];
}

class BrepSource final : public Source {
 public:
  BrepSource(std::string bytes, occt::BrepFile file, occt::ReadModel read)
      : bytes_(std::move(bytes)),
        file_(std::move(file)),
        model_(std::make_shared<const brep::Model>(std::move(read.model))),
        sources_(std::move(read.sources)),
        listed_(std::move(read.surfaces)),
        left_out_(occt::left_out(file_, read.again)) {
    for (std::size_t k = 0; k < listed_.size(); ++k) {
      const brep::SplineSurface& s = model_->surfaces[k];
      surfaces_.push_back(
          {s.id, {}, "unknown", std::shared_ptr<const Surface>(model_, &s.surface)});
      back_.push_back(read.places[listed_[k]].inverse());
    }
  }

  const std::string& name() const override { return model_->name; }
  std::string_view format() const override { return "Open CASCADE"; }
  std::vector<LeftOut> left_out() const override { return left_out_; }
  const std::vector<SourceSurface>& surfaces() const override { return surfaces_; }
  const std::vector<brep::UnreadableSurface>& unreadable() const override {
    return model_->unreadable;
  }
  std::shared_ptr<const brep::Model> model() const override { return model_; }
  Expected<void> can_move_edge(const std::string& id) const override {
    return occt::can_move(file_, sources_, id);
  }

  Expected<std::string> save(
      std::span<const std::shared_ptr<const Surface>> surfaces,
      std::span<const std::string> followed,
      std::span<const std::shared_ptr<const Curve>> /*curves*/) const override {
    TextChanges changes;
    std::vector<brep::Replacement> changed;
    std::set<int> changed_surfaces;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] == surfaces_[k].surface) continue;
      if (!followed.empty()) changed.push_back({surfaces_[k].id, *surfaces[k]});
      const auto& listed = **file_.surfaces[listed_[k]].spline;
      const std::size_t before = changes.size();
      auto status =
          add_changes(listed, *surfaces_[k].surface, *surfaces[k], print_brep, changes, back_[k]);
      if (!status) return std::unexpected(std::move(status.error()));
      if (changes.size() == before) continue;
      changed_surfaces.insert(static_cast<int>(listed_[k]) + 1);
      for (const occt::BrepShape& face :
           file_.shapes) {  // its triangles are those of the surface before
        if (face.kind != occt::Shape::face ||
            static_cast<std::size_t>(face.geometry) != listed_[k] + 1)
          continue;
        if (face.triangulation.end > face.triangulation.begin)
          changes.emplace_back(face.triangulation, std::string());
      }
    }
    const auto moved = brep::moved_edges(*model_, changed, followed);
    if (!moved) return std::unexpected(moved.error());
    auto edges = occt::edge_changes(file_, sources_, *moved);
    if (!edges) return std::unexpected(edges.error());
    changes.insert(changes.end(), edges->begin(), edges->end());
    if (changes.empty()) return bytes_;
    // Read again: how far apart the curves of the edges are now.
    const auto written = occt::BrepFile::parse(with_changes(bytes_, changes), name());
    if (!written) return std::unexpected(written.error());
    const auto tolerances =
        occt::tolerance_changes(file_, *written, changed_surfaces, *moved, sources_);
    changes.insert(changes.end(), tolerances.begin(), tolerances.end());
    return with_changes(bytes_, std::move(changes));
  }

 private:
  std::string bytes_;
  occt::BrepFile file_;
  std::shared_ptr<const brep::Model> model_;
  occt::ReadModel::Sources sources_;
  std::vector<SourceSurface> surfaces_;
  std::vector<std::size_t> listed_;  // surface of the file that each is
  std::vector<Eigen::Affine3d> back_;
  std::vector<LeftOut> left_out_;
};

Expected<std::shared_ptr<const Source>> open_brep(std::string bytes, std::string name) {
  auto file = occt::BrepFile::parse(bytes, name);
  if (!file) return std::unexpected(std::move(file.error()));
  occt::ReadModel read = occt::read_model(*file, std::move(name));
  return std::make_shared<const BrepSource>(std::move(bytes), *std::move(file), std::move(read));
}

bool is_brep(std::string_view bytes) {
  return bytes.substr(0, 400).find("CASCADE Topology V") != std::string_view::npos;
}

constexpr std::string_view brep_endings[] = {".brep", ".brp"};

}  // namespace

Format brep_format() {
  return {.id = "brep",
          .name = "Open CASCADE",
          .endings = brep_endings,
          .media_type = "model/x-brep",
          .content = FormatContent::surfaces,
          .holds = "surfaces with their faces, and everything else of an opened file byte for byte",
          .recognises = is_brep,
          .open = open_brep};
}

}  // namespace knead::detail
