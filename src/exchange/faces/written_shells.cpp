#include "written_shells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <unordered_map>

#include "brep/tessellation/face_tessellator.hpp"

namespace knead::detail {
namespace {

using brep::Index;

constexpr double half_radian = 0.031;  // chords of the mesh by which volumes are told

/// A use of an edge by a face, along the edge where the normal of the face is its own.
struct EdgeRun {
  std::size_t face = 0;  // place in the list of faces
  bool forward = true;
};

/// A connected set of faces.
struct Patchwork {
  WrittenShell shell;
  bool turned = false;           // the model turns its faces
  std::optional<double> volume;  // of a closed one
  Eigen::AlignedBox3d box = {};
};

// A file of solids names shells: lists of faces that share edges and agree in orientation. The
// model holds faces and, where it came from a file, shells; sculpted and added faces may belong to
// none. The shells to write are found in three steps. (1) Connected sets of faces by union–find
// over the uses of edges, faces of different shells of the model kept apart though they touch. (2)
// In each set the faces are turned breadth first until neighbours run along every common edge in
// opposite directions; a set is closed if every edge has exactly two such uses, and is a sheet if
// an edge has three or the turns contradict one another, as on a Möbius strip. (3) The sign of the
// enclosed volume tells outer shells from hollows.
class ShellFinder {
 public:
  ShellFinder(const brep::Model& model, std::span<const Index> faces)
      : model_(model), faces_(faces) {
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const brep::Face& face = model.faces[faces[k]];
      senses_.push_back(face.sense() > 0);
      for (const brep::Bound& bound : face.bounds) {
        for (const brep::EdgeUse& use : bound.edges) {
          runs_[use.edge].push_back({k, (use.forward == bound.forward) != face.turned});
        }
      }
    }
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
      for (const Index face : model.shells[s].faces) shell_of_.try_emplace(face, s);
    }
  }

  WrittenShells find() {
    std::vector<Patchwork> closed;
    WrittenShells result;
    const auto parts = connected();
    const auto runs = runs_of(parts);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Patchwork made = patchwork(parts[p], runs[p]);
      if (made.shell.closed)
        closed.push_back(std::move(made));
      else
        result.sheets.push_back(std::move(made.shell));
    }
    brep::FaceTessellator tessellator(model_, {half_radian});
    for (Patchwork& body : closed) measure(body, tessellator);
    make_solids(closed, result);
    return result;
  }

 private:
  [[nodiscard]] std::vector<std::vector<std::size_t>> connected() const {
    std::vector<std::size_t> root(faces_.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::size_t k) {
      while (root[k] != k) k = root[k] = root[root[k]];
      return k;
    };
    const auto shell = [&](std::size_t k) {
      const auto found = shell_of_.find(faces_[k]);
      return found == shell_of_.end() ? model_.shells.size() : found->second;
    };
    for (const auto& [edge, runs] : runs_) {
      std::map<std::size_t, std::size_t> first;  // face of each shell
      for (const EdgeRun& run : runs) {
        const auto [at, fresh] = first.try_emplace(shell(run.face), run.face);
        if (!fresh) root[find(run.face)] = find(at->second);
      }
    }
    std::map<std::size_t, std::size_t> place;
    std::vector<std::vector<std::size_t>> result;
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const auto [at, fresh] = place.try_emplace(find(k), result.size());
      if (fresh) result.emplace_back();
      result[at->second].push_back(k);
    }
    return result;
  }

  using Runs = std::map<Index, std::vector<EdgeRun>>;

  /// The uses of edges by the faces of each part alone.
  [[nodiscard]] std::vector<Runs> runs_of(
      const std::vector<std::vector<std::size_t>>& parts) const {
    std::vector<std::size_t> part_of(faces_.size(), 0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (const std::size_t k : parts[p]) part_of[k] = p;
    }
    std::vector<Runs> result(parts.size());
    for (const auto& [edge, runs] : runs_) {
      for (const EdgeRun& run : runs) result[part_of[run.face]][edge].push_back(run);
    }
    return result;
  }

  static bool opposite(const std::vector<EdgeRun>& runs, const std::map<std::size_t, bool>& flips) {
    const auto forward = [&](const EdgeRun& run) { return run.forward != flips.at(run.face); };
    // A seam, which one face uses twice, passes too: it runs along it there and back.
    return runs.size() == 2 && forward(runs[0]) != forward(runs[1]);
  }

  /// Which faces to turn so that neighbours agree; none where that is impossible.
  static std::optional<std::map<std::size_t, bool>> agreeing(const std::vector<std::size_t>& part,
                                                             const Runs& runs) {
    std::map<std::size_t, std::vector<std::pair<std::size_t, bool>>>
        neighbours;  // and whether they differ
    for (const auto& [edge, uses] : runs) {
      if (uses.size() > 2) return std::nullopt;
      if (uses.size() < 2) continue;
      const bool differ = uses[0].forward == uses[1].forward;
      neighbours[uses[0].face].emplace_back(uses[1].face, differ);
      neighbours[uses[1].face].emplace_back(uses[0].face, differ);
    }
    std::map<std::size_t, bool> result = {{part.front(), false}};
    std::queue<std::size_t> next({part.front()});
    for (; !next.empty(); next.pop()) {
      const bool is_own = result.at(next.front());
      for (const auto& [other, differ] : neighbours[next.front()]) {
        const auto [at, fresh] = result.try_emplace(other, is_own != differ);
        if (fresh) next.push(other);
        if (at->second != (is_own != differ)) return std::nullopt;
      }
    }
    return result;
  }

  Patchwork patchwork(const std::vector<std::size_t>& part, const Runs& runs) {
    Patchwork result;
    if (const auto flips = agreeing(part, runs)) {
      for (const auto& [k, flip] : *flips) senses_[k] = senses_[k] != flip;
      result.shell.closed = std::ranges::all_of(
          runs, [&](const auto& edge) { return opposite(edge.second, *flips); });
    }
    result.turned = true;
    for (const std::size_t k : part) {
      const brep::Face& face = model_.faces[faces_[k]];
      result.shell.faces.push_back({faces_[k], senses_[k]});
      result.turned = result.turned && face.turned;
    }
    return result;
  }

  // V = 1/6 Σ a · (b × c) over the triangles, of which only the sign is used: a coarse mesh is
  // enough. Of a closed mesh the sum does not depend on the origin; one of its own points keeps it
  // clear of cancellation far from the origin of space. A face that has no mesh leaves the volume
  // unknown.
  void measure(Patchwork& body, brep::FaceTessellator& tessellator) const {
    double volume = 0;
    std::optional<Point> origin;
    for (const WrittenFace& written : body.shell.faces) {
      const brep::Face& face = model_.faces[written.face];
      const auto on = tessellator.face_on_surface(face);
      const auto mesh = on ? tessellator.mesh(*on) : std::unexpected(on.error());
      if (!mesh || mesh->points.empty()) return;
      if (!origin) origin = mesh->points.front();
      const double way = written.same_sense == (face.sense() > 0) ? 1 : -1;
      for (const Point& p : mesh->points) body.box.extend(p);
      for (const auto& [a, b, c] : mesh->triangles) {
        volume += way * (mesh->points[a] - *origin)
                            .dot((mesh->points[b] - *origin).cross(mesh->points[c] - *origin));
      }
    }
    body.volume = volume / 6;
  }

  static void turn(WrittenShell& shell) {
    for (WrittenFace& face : shell.faces) face.same_sense = !face.same_sense;
  }

  // A shell with negative volume bounds a hollow of the solid whose box contains its own; of
  // several the one with the smallest box, since solids in solids are rare. A hollow is written
  // with its faces turned outward, as a void of ISO 10303-42 (brep_with_voids) is an oriented shell
  // that turns them again. One that lies in no solid is a body whose faces all point inward, and
  // becomes a solid once turned.
  static void make_solids(std::vector<Patchwork>& closed, WrittenShells& result) {
    std::vector<std::size_t> solids, hollows;
    for (std::size_t k = 0; k < closed.size(); ++k) {
      // No mesh tells the sides: the model is believed, except where it turns every face.
      if (!closed[k].volume && closed[k].turned)
        result.sheets.push_back(std::move(closed[k].shell));
      else
        (closed[k].volume.value_or(1) < 0 ? hollows : solids).push_back(k);
    }
    std::map<std::size_t, std::vector<std::size_t>> inside;
    for (const std::size_t hollow : hollows) {
      turn(closed[hollow].shell);
      std::optional<std::size_t> around;
      for (const std::size_t solid : solids) {
        if (!closed[solid].box.contains(closed[hollow].box)) continue;
        if (!around || closed[solid].box.volume() < closed[*around].box.volume()) around = solid;
      }
      inside[around.value_or(hollow)].push_back(hollow);
    }
    for (std::size_t k = 0; k < closed.size(); ++k) {
      const auto found = inside.find(k);
      const bool alone =
          found != inside.end() && std::ranges::find(found->second, k) != found->second.end();
      if (std::ranges::find(solids, k) == solids.end() && !alone) continue;
      WrittenSolid& solid = result.solids.emplace_back();
      solid.outer = closed[k].shell;
      if (found == inside.end() || alone) continue;
      for (const std::size_t hollow : found->second) solid.hollows.push_back(closed[hollow].shell);
    }
  }

  const brep::Model& model_;
  std::span<const Index> faces_;
  std::vector<bool> senses_;  // of the faces, as they are written
  Runs runs_;
  std::unordered_map<Index, std::size_t> shell_of_;
};

}  // namespace

bool runs_forward(const brep::Bound& bound, const brep::Face& face, const WrittenFace& written) {
  return bound.forward == (written.same_sense == face.same_sense);
}

WrittenShells written_shells(const brep::Model& model, std::span<const brep::Index> faces) {
  return ShellFinder(model, faces).find();
}

}  // namespace knead::detail
