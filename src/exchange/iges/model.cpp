#include "model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "brep/fitted_curve.hpp"
#include "brep/geometry_forms.hpp"
#include "brep/model_builder.hpp"
#include "curves.hpp"
#include "exchange/length_units.hpp"
#include "knead/spline/evaluate.hpp"
#include "subfigures.hpp"

namespace knead::iges {
namespace {

constexpr double default_uncertainty = 1e-7;

bool is_spline(int type) { return type == 128 || type == 114 || type == 118; }
bool is_face(int type) { return type == 143 || type == 144 || type == 510; }

/// The surface of a face: the first pointer of 144 and 510, the second of 143.
int surface_of(const File& file, int face) {
  const auto parameters = file.parameters(face);
  const std::size_t at = file.find(face)->type == 143 ? 2 : 1;
  return parameters && parameters->values.size() > at ? integer(parameters->values[at]).value_or(0)
                                                      : 0;
}

/// The faces (510) whose normals are opposite to those of their surfaces. A shell (514) lists its
/// faces, each with a flag that is 0 then; a solid (186) its shell and the shells of its voids,
/// each with a flag that is 0 where all of that is turned once more (IGES 5.3, § 4.147 and 4.49).
/// Of several shells with the same face the first counts.
std::set<int> turned_faces(const File& file) {
  const auto pairs = [&](int number, int count_at, const auto& act) {  // pointer and flag, so often
    const auto parameters = file.parameters(number);
    if (!parameters) return;
    const auto& values = parameters->values;
    const auto value = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    std::size_t at = static_cast<std::size_t>(count_at) + 1;
    for (int n = value(at - 1); n > 0 && at + 1 < values.size(); --n, at += 2)
      act(value(at), value(at + 1) == 0);
  };
  std::map<int, bool> shells, faces;
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    if (file.entities()[k].type != 186) continue;
    const auto note = [&](int shell, bool turned) { shells.try_emplace(shell, turned); };
    const auto parameters = file.parameters(File::number(k));
    if (parameters && parameters->values.size() > 2) {
      note(integer(parameters->values[1]).value_or(0),
           integer(parameters->values[2]).value_or(1) == 0);
    }
    pairs(File::number(k), 3, note);
  }
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    if (file.entities()[k].type != 514) continue;
    const auto shell = shells.find(File::number(k));
    const bool all = shell != shells.end() && shell->second;
    pairs(File::number(k), 1,
          [&](int face, bool turned) { faces.try_emplace(face, turned != all); });
  }
  std::set<int> result;
  for (const auto& [face, turned] : faces) {
    if (turned) result.insert(face);
  }
  return result;
}

class ModelReader {
 public:
  explicit ModelReader(const File& file)
      : file_(file),
        builder_(file.name(), File::number(file.entities().size())),
        curves_(file),
        turned_(turned_faces(file)),
        edges_(builder_.model(), [this] { return brep::ModelBuilder::name(builder_.fresh()); }) {
    // Subfigures (408) stand in several places: what seems to meet need not.
    if (std::ranges::find(file.entities(), 408, &Entity::type) == file.entities().end())
      together_ = 0;
    const KnownLengthUnit* unit = length_unit_named(file.global().unit);
    if (unit == nullptr) return;
    unit_ = unit->name;
    metres_ = unit->millimetres / 1000;
    uncertainty_ = file.global().resolution > 0 ? file.global().resolution : default_uncertainty;
  }

  // Faces come first, since the matrix of a face moves its surface; then all surfaces, then bounds.
  //   144 trimmed surface   surface, N1, N2, outer, N2 inner boundaries (142)
  //   143 bounded surface   kind, surface, N, N boundaries (141)
  //   510 face              surface, N, whether the first is the outer one, N loops (508)
  ReadModel read() {
    std::vector<int> faces;
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k);
      if (!is_face(file_.entities()[k].type)) continue;
      faces.push_back(number);
      const auto transform = transform_of(file_, number);
      if (transform && !transform->matrix().isIdentity(0))
        outer_.try_emplace(surface_of(file_, number), *transform);
    }
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      if (is_spline(file_.entities()[k].type)) add_spline(File::number(k));
      if (file_.entities()[k].type == 140) report_offset(File::number(k));
    }
    for (const int face : faces) {
      if (curves_.exceeded()) break;  // what is left is not known: its surfaces count as whole
      add_face(face);
    }
    ReadModel result{std::move(builder_).complete(unit_, metres_), std::move(sources_), {}};
    result.unplaced = add_subfigures(file_, result.model);
    return result;
  }

 private:
  Eigen::Affine3d outer(int number) const {
    const auto found = outer_.find(number);
    return found == outer_.end() ? Eigen::Affine3d::Identity() : found->second;
  }

  void add_spline(int number) {
    auto surface = read_surface(file_, number, outer(number));
    if (!surface) {
      brep::Support support;
      support.id = brep::ModelBuilder::name(number);
      support.kind = fmt::format("IGES_SURFACE_{}", file_.find(number)->type);
      support.wrong = brep::fault(surface.error());
      supports_.emplace(number, builder_.add_support(std::move(support)));
      builder_.add_unreadable(number, std::move(surface.error()));
      return;
    }
    supports_.emplace(number, builder_.add_surface(number, file_.find(number)->label,
                                                   *std::move(surface), unit_, uncertainty_));
  }

  void report_offset(int number) {
    builder_.add_unreadable(
        number,
        file_
            .error(number,
                   "an offset surface is no B-spline surface, and would move with the one below",
                   "convert it to a B-spline surface in the program that wrote the file")
            .error());
  }

  brep::Index support_of(int number) {
    const auto known = supports_.find(number);
    if (known != supports_.end()) return known->second;
    brep::Support support = other_surface(file_, number, outer(number), curves_);
    support.uncertainty = uncertainty_;
    return supports_[number] = builder_.add_support(std::move(support));
  }

  void add_face(int number) {
    const int surface = surface_of(file_, number);
    const auto move = transform_of(file_, number);
    const auto parameters = file_.parameters(number);
    if (surface == 0 || !move || !parameters) return;
    const auto& values = parameters->values;
    const auto pointer = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    const int type = file_.find(number)->type;
    std::vector<int> boundaries;
    std::size_t first = 4, count = 0;
    if (type == 144) {
      if (pointer(2) == 0 && pointer(3) == 0) return;
      boundaries.push_back(pointer(2) == 0 ? 0 : pointer(4));
      first = 5;
      count = static_cast<std::size_t>(std::max(pointer(3), 0));
    } else {
      count = static_cast<std::size_t>(std::max(pointer(type == 143 ? 3 : 2), 0));
    }
    for (std::size_t k = first; k < first + count && k < values.size(); ++k)
      boundaries.push_back(pointer(k));
    brep::Face face;
    face.id = brep::ModelBuilder::name(number);
    face.kind = "ADVANCED_FACE";
    face.same_sense = !turned_.contains(number);
    for (const int boundary : boundaries) {
      brep::Bound bound = read_loop(boundary, surface, *move);
      if (bound.kind == brep::Bound::Kind::unknown) continue;
      // Loops of IGES run round the normal of the surface, not that of the face.
      bound.forward = face.same_sense;
      face.bounds.push_back(std::move(bound));
    }
    face.support = support_of(surface);
    if (!face.bounds.empty()) builder_.add_face(std::move(face));
  }

  /// Of an unknown kind if there is none.
  brep::Bound read_loop(int number, int surface, const Eigen::Affine3d& move) {
    const Entity* entity = file_.find(number);
    const auto parameters =
        entity != nullptr ? file_.parameters(number) : Expected<Parameters>(input_error(""));
    std::vector<Piece> pieces;
    if (entity != nullptr && parameters && entity->type == 508) {
      if (auto loop = read_shared_loop(*parameters, move)) return *std::move(loop);
    }
    Expected<void> read = file_.error(number, "a boundary of an unknown kind");
    if (entity != nullptr && parameters && entity->type == 142)
      read = add_curve(*parameters, surface, move, pieces);
    if (entity != nullptr && parameters && entity->type == 141)
      read = add_boundary(*parameters, move, pieces);
    if (read && !pieces.empty()) return edge_loop(pieces);
    // A face whose boundary is not known must not pass for a whole one.
    brep::Bound unknown;
    unknown.kind = brep::Bound::Kind::edges;
    unknown.wrong = brep::fault(read ? file_.error(number, "its boundary has no curves").error()
                                     : read.error());
    return unknown;
  }

  /// A curve on a surface (142): how it was made, surface, curve in parameters, curve in space,
  /// which is preferred.
  Expected<void> add_curve(const Parameters& parameters, int surface, const Eigen::Affine3d& move,
                           std::vector<Piece>& pieces) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    if (pointer(4) != 0) return curves_.add(pointer(4), move, pieces);
    std::vector<Piece> flat;
    if (auto status = curves_.add(pointer(3), Eigen::Affine3d::Identity(), flat); !status)
      return status;
    const brep::SplineSurface* spline = spline_of(surface);
    if (spline == nullptr)
      return file_.error(surface, "a boundary in parameters of another surface than a B-spline");
    const Surface& on = spline->surface;
    const Interval u = on.knots(0).domain(), v = on.knots(1).domain();
    for (const Piece& piece : flat) {
      const auto above = [&](double t) {
        const Point p = piece.at(t);
        return evaluate_point<2>(
            on, {std::clamp(p.x(), u.lower, u.upper), std::clamp(p.y(), v.lower, v.upper)});
      };
      auto fitted = brep::lifted_curve(above, piece.corners);
      if (!fitted) return std::unexpected(std::move(fitted.error()));
      if (!*fitted) continue;  // a pole
      Piece lifted;
      lifted.number = piece.number;
      lifted.name = piece.name;
      lifted.in_space = false;
      lifted.set(std::make_shared<const Curve>(**std::move(fitted)), {0, 1});
      pieces.push_back(std::move(lifted));
    }
    return {};
  }

  /// A boundary (141): kind, preference, surface, number of curves; of each the curve, whether it
  /// runs along it (1) or against it (2), and its curves in parameters.
  Expected<void> add_boundary(const Parameters& parameters, const Eigen::Affine3d& move,
                              std::vector<Piece>& pieces) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    std::size_t at = 5;
    for (int n = pointer(4); n > 0 && at + 2 < values.size(); --n) {
      std::vector<Piece> part;
      if (auto status = curves_.add(pointer(at), move, part); !status) return status;
      if (pointer(at + 1) == 2) {
        std::ranges::reverse(part);
        for (Piece& piece : part) piece.reversed = !piece.reversed;
      }
      pieces.insert(pieces.end(), part.begin(), part.end());
      at += 3 + static_cast<std::size_t>(std::max(pointer(at + 2), 0));
    }
    return {};
  }

  brep::Bound edge_loop(std::vector<Piece>& pieces) {
    return edges_.bound(pieces, file_.global().resolution, together_,
                        [&](const Piece& piece, const brep::BoundaryEdges::Use& use) {
                          sources_.note(builder_.model().edges[use.edge].id, piece, use.turned);
                        });
  }

  /// A loop (508) of a B-rep, whose edges are shared: their number, and of each whether it is an
  /// edge or a vertex, its list, its place there, whether it runs along it, and its curves in
  /// parameters.
  Expected<brep::Bound> read_shared_loop(const Parameters& parameters,
                                         const Eigen::Affine3d& move) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    brep::Bound bound;
    std::size_t at = 2;
    for (int n = pointer(1); n > 0 && at + 4 < values.size(); --n) {
      if (pointer(at) == 1) {
        bound.vertex = shared_vertex(pointer(at + 1), pointer(at + 2), move);
      } else {
        const auto edge = shared_edge(pointer(at + 1), pointer(at + 2), move);
        if (!edge) return std::unexpected(edge.error());
        bound.edges.push_back({*edge, pointer(at + 3) != 0});
      }
      at += 5 + 2 * static_cast<std::size_t>(std::max(pointer(at + 4), 0));
    }
    brep::settle_kind(bound);
    return bound;
  }

  brep::Index shared_vertex(int list, int index, const Eigen::Affine3d& move) {
    const auto [found, added] = shared_vertices_.try_emplace({list, index}, brep::none);
    if (!added) return found->second;
    const auto parameters = vertex_list(list);
    Point p = Point::Zero();
    if (index >= 1 && 3 * static_cast<std::size_t>(index) <= parameters.size()) {
      const double* xyz = &parameters[3 * static_cast<std::size_t>(index - 1)];
      p = move * Point(xyz[0], xyz[1], xyz[2]);
    }
    const int number = builder_.fresh();
    sources_.vertices.emplace(brep::ModelBuilder::name(number), EdgeVertex{list, index, move});
    return found->second = builder_.add_vertex(number, p);
  }

  /// The coordinates of a vertex list (502), read once.
  const std::vector<double>& vertex_list(int list) {
    const auto [found, added] = vertex_lists_.try_emplace(list);
    const auto parameters = added ? file_.parameters(list) : Expected<Parameters>(input_error(""));
    if (parameters && parameters->values.size() > 2) {
      const std::size_t count = (parameters->values.size() - 2) / 3;
      if (auto all = numbers(file_, list, *parameters, 2, 3 * count))
        found->second = *std::move(all);
    }
    return found->second;
  }

  /// Entry of an edge list (504): curve, and list and place of the vertices at its ends.
  Expected<brep::Index> shared_edge(int list, int index, const Eigen::Affine3d& move) {
    const auto [found, added] = shared_edges_.try_emplace({list, index}, brep::none);
    if (found->second != brep::none) return found->second;
    const auto [lists, fresh] = edge_lists_.try_emplace(list);
    const auto parameters = fresh ? file_.parameters(list) : Expected<Parameters>(input_error(""));
    if (parameters) {
      for (const std::string& value : parameters->values)
        lists->second.push_back(integer(value).value_or(0));
    }
    const std::vector<int>& numbers = lists->second;
    const std::size_t at = 2 + 5 * static_cast<std::size_t>(std::max(index, 1) - 1);
    if (at + 5 > numbers.size())
      return file_.error(list, fmt::format("it has no edge {}", index), "get the whole file");
    std::vector<Piece> pieces;
    if (auto status = curves_.add(numbers[at], move, pieces); !status)
      return std::unexpected(status.error());
    const brep::Index from = shared_vertex(numbers[at + 1], numbers[at + 2], move),
                      to = shared_vertex(numbers[at + 3], numbers[at + 4], move);
    if (pieces.size() != 1) {
      pieces.assign(1, Piece{});
      pieces[0].number = numbers[at];
      pieces[0].name = brep::ModelBuilder::name(numbers[at]);
      pieces[0].in_space = false;
      pieces[0].geometry = file_.error(numbers[at], "it is made of several curves, as no edge is");
    }
    const brep::Index edge = edges_.add(pieces[0], from, to);
    sources_.note(builder_.model().edges[edge].id, pieces[0], false);
    return shared_edges_[{list, index}] = edge;
  }

  /// The B-spline surface of this number, or null.
  const brep::SplineSurface* spline_of(int number) const {
    return builder_.spline_at(supports_.contains(number) ? supports_.at(number) : brep::none);
  }

  const File& file_;
  brep::ModelBuilder builder_;
  CurveReader curves_;
  std::set<int> turned_;
  brep::BoundaryEdges edges_;
  brep::BoundaryEdges::Group together_;
  EdgeSources sources_;
  std::string unit_ = "unknown";
  double metres_ = 0, uncertainty_ = 0;
  std::map<int, Eigen::Affine3d> outer_;
  std::map<int, brep::Index> supports_;  // by entity
  std::map<std::pair<int, int>, brep::Index> shared_vertices_, shared_edges_;
  std::map<int, std::vector<double>> vertex_lists_;
  std::map<int, std::vector<int>> edge_lists_;
};

}  // namespace

ReadModel read_model(const File& file) { return ModelReader(file).read(); }

Expected<Eigen::Affine3d> outer_transform(const File& file, int surface) {
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    if (is_face(file.entities()[k].type) && file.entities()[k].transform != 0 &&
        surface_of(file, File::number(k)) == surface) {
      return transform_of(file, File::number(k));
    }
  }
  return Eigen::Affine3d::Identity();
}

}  // namespace knead::iges
