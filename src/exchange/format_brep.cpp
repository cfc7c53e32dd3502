#include <fmt/format.h>

#include <charconv>
#include <set>

#include "brep_moved.hpp"
#include "brep_step.hpp"
#include "format_list.hpp"
#include "knead/exchange/step_file.hpp"
#include "moved_edge.hpp"

namespace knead::detail {
namespace {

/// Type 9: flags, degrees, numbers of poles and knots, poles with v fast, knots with multiplicities.
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
  std::string text = fmt::format("9 {} {} 0 0 {} {} {} {} {} {}\n", rational, rational, surface.knots(0).degree(),
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
  BrepSource(std::string bytes, brep::BrepFile file, const brep::BrepView& view, step::File read)
      : bytes_(std::move(bytes)),
        file_(std::move(file)),
        view_(std::move(read)),
        sources_(view.sources),
        unreadable_(view.unreadable) {
    for (const step::SurfaceEntity& s : view_.surfaces()) {
      std::size_t k = 0;
      std::from_chars(s.id.data() + 1, s.id.data() + s.id.size(), k);
      --k;
      surfaces_.push_back({s.id, {}, "unknown", std::make_shared<const Surface>(s.surface)});
      listed_.push_back(k);
      back_.push_back(view.places[k].inverse());
    }
    if (view.again > 0) {
      remarks_.push_back(fmt::format("{} faces are used again elsewhere: each is shown once", view.again));
    }
  }

  const std::string& name() const override { return view_.name(); }
  std::string_view format() const override { return "Open CASCADE"; }
  std::vector<std::string> remarks() const override { return remarks_; }
  const std::vector<SourceSurface>& surfaces() const override { return surfaces_; }
  const std::vector<UnreadableSurface>& unreadable() const override { return unreadable_; }
  const step::File* step_file() const override { return &view_; }
  Expected<void> can_move_edge(const std::string& id) const override { return brep::can_move(file_, sources_, id); }

  Expected<std::string> save(std::span<const std::shared_ptr<const Surface>> surfaces,
                             std::span<const std::string> followed,
                             std::span<const std::shared_ptr<const Curve>> /*curves*/) const override {
    TextChanges changes;
    std::vector<step::Replacement> changed;
    std::set<int> changed_surfaces;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] == surfaces_[k].surface) continue;
      if (!followed.empty()) changed.push_back({surfaces_[k].id, *surfaces[k]});
      const auto& listed = **file_.surfaces[listed_[k]].spline;
      const std::size_t before = changes.size();
      auto done = add_changes(listed, *surfaces_[k].surface, *surfaces[k], print_brep, changes, back_[k]);
      if (!done) return std::unexpected(std::move(done.error()));
      if (changes.size() == before) continue;
      changed_surfaces.insert(static_cast<int>(listed_[k]) + 1);
      for (const brep::BrepShape& face : file_.shapes) {  // its triangles are those of the surface before
        if (face.kind != brep::Shape::face || static_cast<std::size_t>(face.geometry) != listed_[k] + 1) continue;
        if (face.triangulation.end > face.triangulation.begin) changes.emplace_back(face.triangulation, std::string());
      }
    }
    const auto moved = step::moved_edges(view_, changed, followed);
    if (!moved) return std::unexpected(moved.error());
    auto edges = brep::edge_changes(file_, sources_, *moved);
    if (!edges) return std::unexpected(edges.error());
    changes.insert(changes.end(), edges->begin(), edges->end());
    if (changes.empty()) return bytes_;
    // Read again: how far apart the curves of the edges are now.
    const auto written = brep::BrepFile::parse(with_changes(bytes_, changes), name());
    if (!written) return std::unexpected(written.error());
    const auto tolerances = brep::tolerance_changes(file_, *written, changed_surfaces, *moved, sources_);
    changes.insert(changes.end(), tolerances.begin(), tolerances.end());
    return with_changes(bytes_, std::move(changes));
  }

 private:
  std::string bytes_;
  brep::BrepFile file_;
  step::File view_;
  brep::BrepView::Sources sources_;
  std::vector<UnreadableSurface> unreadable_;
  std::vector<SourceSurface> surfaces_;
  std::vector<std::size_t> listed_;  // surface of the file that each is
  std::vector<Eigen::Affine3d> back_;
  std::vector<std::string> remarks_;
};

Expected<std::shared_ptr<const Source>> open_brep(std::string bytes, std::string name) {
  auto file = brep::BrepFile::parse(bytes, name);
  if (!file) return std::unexpected(std::move(file.error()));
  brep::BrepView view = brep::step_view(*file);
  auto read = step::File::parse(std::move(view.text), std::move(name));
  if (!read) return std::unexpected(std::move(read.error()));
  return std::make_shared<const BrepSource>(std::move(bytes), *std::move(file), view, *std::move(read));
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
