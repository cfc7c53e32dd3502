#include "iges_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "iges_curves.hpp"
#include "iges_subfigures.hpp"
#include "knead/exchange/step_text.hpp"
#include "knead/spline/evaluate.hpp"
#include "step_print.hpp"

namespace knead::iges {
namespace {

using Ids = std::vector<int>;

bool is_spline(int type) { return type == 128 || type == 114 || type == 118; }
bool is_face(int type) { return type == 143 || type == 144 || type == 510; }

/// The surface of a face: the first pointer of 144 and 510, the second of 143.
int surface_of(const File& file, int face) {
  const auto parameters = file.parameters(face);
  const std::size_t at = file.find(face)->type == 143 ? 2 : 1;
  return parameters && parameters->values.size() > at ? integer(parameters->values[at]).value_or(0) : 0;
}

/// The faces (510) whose normals are opposite to those of their surfaces. A shell (514) lists its faces, each with a
/// flag that is 0 then; a solid (186) its shell and the shells of its voids, each with a flag that is 0 where all of
/// that is turned once more (IGES 5.3, § 4.147 and 4.49). Of several shells with the same face the first counts.
std::set<int> turned_faces(const File& file) {
  const auto pairs = [&](int number, int count_at, const auto& act) {  // pointer and flag, so often
    const auto parameters = file.parameters(number);
    if (!parameters) return;
    const auto& values = parameters->values;
    const auto value = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    std::size_t at = static_cast<std::size_t>(count_at) + 1;
    for (int n = value(at - 1); n > 0 && at + 1 < values.size(); --n, at += 2) act(value(at), value(at + 1) == 0);
  };
  std::map<int, bool> shells, faces;
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    if (file.entities()[k].type != 186) continue;
    const auto note = [&](int shell, bool turned) { shells.try_emplace(shell, turned); };
    const auto parameters = file.parameters(File::number(k));
    if (parameters && parameters->values.size() > 2) {
      note(integer(parameters->values[1]).value_or(0), integer(parameters->values[2]).value_or(1) == 0);
    }
    pairs(File::number(k), 3, note);
  }
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    if (file.entities()[k].type != 514) continue;
    const auto shell = shells.find(File::number(k));
    const bool all = shell != shells.end() && shell->second;
    pairs(File::number(k), 1, [&](int face, bool turned) { faces.try_emplace(face, turned != all); });
  }
  std::set<int> result;
  for (const auto& [face, turned] : faces) {
    if (turned) result.insert(face);
  }
  return result;
}

class ViewBuilder {
 public:
  explicit ViewBuilder(const File& file)
      : file_(file),
        records_(File::number(file.entities().size())),
        curves_(file, records_),
        turned_(turned_faces(file)),
        edges_(records_, std::ranges::find(file.entities(), 408, &Entity::type) == file.entities().end()) {}

  StepView build() {
    std::vector<int> faces;
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k);
      if (!is_face(file_.entities()[k].type)) continue;
      faces.push_back(number);
      const auto own = transform_of(file_, number);
      if (own && !own->matrix().isIdentity(0)) outer_.try_emplace(surface_of(file_, number), *own);
    }
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      if (is_spline(file_.entities()[k].type)) add_spline(File::number(k));
      if (file_.entities()[k].type == 140) report_offset(File::number(k));
    }
    for (const int face : faces) {
      if (exceeds(file_, records_)) break;  // what is left is not known: its surfaces count as whole
      add_face(face);
    }
    const std::string& unit = file_.global().unit;
    std::string context = "$";
    if (step::is_unit(unit)) {
      const double gap = file_.global().resolution > 0 ? file_.global().resolution : 1e-7;
      context = step::print_context(
          unit, gap, [&](const std::string& record) { return fmt::format("#{}", records_.add(record)); });
    }
    for (const auto& [number, surface] : splines_) shown_.insert(number);
    add_subfigures(file_, shown_, context, records_);
    view_.text = records_.exchange_structure();
    view_.sources = std::move(edges_.sources());
    return std::move(view_);
  }

 private:
  Eigen::Affine3d outer(int number) const {
    const auto found = outer_.find(number);
    return found == outer_.end() ? Eigen::Affine3d::Identity() : found->second;
  }

  void add_spline(int number) {
    auto surface = read_surface(file_, number, outer(number));
    if (!surface) {
      view_.unreadable.push_back({fmt::format("#{}", number), std::move(surface.error())});
      return;
    }
    records_.surface(number, *surface, file_.find(number)->label);
    splines_.emplace(number, *std::move(surface));
  }

  void report_offset(int number) {
    Error reason = file_
                       .error(number, "an offset surface is no B-spline surface, and would move with the one below",
                              "convert it to a B-spline surface in the program that wrote the file")
                       .error();
    view_.unreadable.push_back({fmt::format("#{}", number), std::move(reason)});
  }

  /// A surface that is no B-spline, as a record.
  int other_surface(int number) {
    if (surfaces_.insert(number).second)
      records_.put(number, surface_record(file_, number, outer(number), records_, curves_));
    return number;
  }

  void add_face(int number) {
    const int surface = surface_of(file_, number);
    const auto move = transform_of(file_, number);
    const auto parameters = file_.parameters(number);
    if (surface == 0 || !move || !parameters) return;
    const auto& values = parameters->values;
    const auto pointer = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    const int type = file_.find(number)->type;
    std::vector<int> boundaries;
    std::size_t first = 4, count = 0;
    if (type == 144) {  // surface, whether its outer boundary is given, number of inner ones, the outer one
      if (pointer(2) == 0 && pointer(3) == 0) return;
      boundaries.push_back(pointer(2) == 0 ? 0 : pointer(4));
      first = 5;
      count = static_cast<std::size_t>(std::max(pointer(3), 0));
    } else {  // 143: kind, surface, their number; 510: surface, their number, whether the first is the outer one
      count = static_cast<std::size_t>(std::max(pointer(type == 143 ? 3 : 2), 0));
    }
    for (std::size_t k = first; k < first + count && k < values.size(); ++k) boundaries.push_back(pointer(k));
    // Loops of IGES run round the normal of the surface, those of STEP round that of the face.
    const std::string_view sense = turned_.contains(number) ? ".F." : ".T.";
    Ids bounds;
    for (const int boundary : boundaries) {
      const int loop = add_loop(boundary, surface, *move);
      if (loop != 0) bounds.push_back(records_.add(fmt::format("FACE_BOUND('',#{},{})", loop, sense)));
    }
    const int below = splines_.contains(surface) ? surface : other_surface(surface);
    if (!bounds.empty()) shown_.insert(number);
    if (!bounds.empty()) {
      records_.put(number, fmt::format("ADVANCED_FACE('',{},#{},{})", list_of(bounds), below, sense));
    }
  }

  /// An EDGE_LOOP or VERTEX_LOOP; 0 if there is none.
  int add_loop(int number, int surface, const Eigen::Affine3d& move) {
    const Entity* entity = file_.find(number);
    const auto parameters = entity != nullptr ? file_.parameters(number) : Expected<Parameters>(input_error(""));
    std::vector<Piece> pieces;
    if (entity != nullptr && parameters && entity->type == 508) {
      if (const auto loop = add_shared_loop(*parameters, move)) return *loop;
    }
    Expected<void> read = file_.error(number, "a boundary of an unknown kind");
    if (entity != nullptr && parameters && entity->type == 142) read = add_curve(*parameters, surface, move, pieces);
    if (entity != nullptr && parameters && entity->type == 141) read = add_boundary(*parameters, move, pieces);
    if (!read || pieces.empty()) {
      // A face whose boundary is not known must not pass for a whole one.
      Piece unknown;
      unknown.number = number;
      unknown.geometry =
          records_.add(fmt::format("IGES_BOUNDARY_{}('D{}')", entity != nullptr ? entity->type : 0, number));
      unknown.at = [](double) { return Point::Zero(); };
      unknown.in_space = false;
      pieces.assign(1, unknown);
    }
    return edge_loop(pieces);
  }

  /// A curve on a surface (142): how it was made, surface, curve in parameters, curve in space, which is preferred.
  Expected<void> add_curve(const Parameters& parameters, int surface, const Eigen::Affine3d& move,
                           std::vector<Piece>& pieces) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    if (pointer(4) != 0) return curves_.add(pointer(4), move, pieces);
    std::vector<Piece> flat;
    if (auto done = curves_.add(pointer(3), Eigen::Affine3d::Identity(), flat); !done) return done;
    const auto spline = splines_.find(surface);
    if (spline == splines_.end()) return input_error("a boundary in parameters of another surface");
    const Surface& on = spline->second;
    const Interval u = on.knots(0).domain(), v = on.knots(1).domain();
    for (const Piece& piece : flat) {
      auto corners = std::make_shared<std::vector<Point>>();
      Ids list;
      const int steps = std::max(piece.samples, 32);
      for (int k = 0; k <= steps; ++k) {
        const Point p = piece.at(static_cast<double>(k) / steps);
        const auto point =
            evaluate_point<2>(on, {std::clamp(p.x(), u.lower, u.upper), std::clamp(p.y(), v.lower, v.upper)});
        if (!point) return std::unexpected(point.error());
        corners->push_back(*point);
        list.push_back(records_.point(*point));
      }
      Piece lifted;
      lifted.number = piece.number;
      lifted.in_space = false;
      lifted.geometry = records_.add("POLYLINE(''," + list_of(list) + ")");
      lifted.at = [corners](double t) {
        const double place = t * static_cast<double>(corners->size() - 1);
        const auto k = std::min(static_cast<std::size_t>(place), corners->size() - 2);
        return Point((*corners)[k] + (place - static_cast<double>(k)) * ((*corners)[k + 1] - (*corners)[k]));
      };
      pieces.push_back(std::move(lifted));
    }
    return {};
  }

  /// A boundary (141): kind, preference, surface, number of curves; of each the curve, whether it runs along it (1) or
  /// against it (2), and its curves in parameters.
  Expected<void> add_boundary(const Parameters& parameters, const Eigen::Affine3d& move, std::vector<Piece>& pieces) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    std::size_t at = 5;
    for (int n = pointer(4); n > 0 && at + 2 < values.size(); --n) {
      std::vector<Piece> own;
      if (auto done = curves_.add(pointer(at), move, own); !done) return done;
      if (pointer(at + 1) == 2) {
        std::ranges::reverse(own);
        for (Piece& piece : own) piece.reversed = !piece.reversed;
      }
      pieces.insert(pieces.end(), own.begin(), own.end());
      at += 3 + static_cast<std::size_t>(std::max(pointer(at + 2), 0));
    }
    return {};
  }

  /// Turns each piece so that it begins where the one before it ends. One that is closed to `same` begins and ends
  /// there both ways: it keeps its direction, in which roundings of its ends say nothing.
  static void chain(std::vector<Piece>& pieces, double same) {
    for (std::size_t k = 0; k < pieces.size() && pieces.size() > 1; ++k) {
      Piece& piece = pieces[k];
      if ((piece.from() - piece.to()).norm() <= same && (piece.at(0.5) - piece.from()).norm() > same) continue;
      if (k == 0) {
        const Piece& next = pieces[1];
        const auto gap = [&](const Point& p) { return std::min((next.from() - p).norm(), (next.to() - p).norm()); };
        if (gap(piece.from()) < gap(piece.to())) piece.reversed = !piece.reversed;
        continue;
      }
      const Point end = pieces[k - 1].to();
      if ((piece.to() - end).norm() < (piece.from() - end).norm()) piece.reversed = !piece.reversed;
    }
  }

  int edge_loop(std::vector<Piece>& pieces) {
    Eigen::AlignedBox3d box;
    for (const Piece& piece : pieces) box.extend(piece.from()).extend(piece.at(0.5));
    const double same = std::max(file_.global().resolution, 1e-6 * box.diagonal().norm());
    if (pieces.size() != 2 || (pieces[0].to() - pieces[1].from()).norm() > 0) chain(pieces, same);
    edges_.begin_loop(same);
    Ids oriented;
    for (const Piece& piece : pieces) {
      const auto [edge, back] = edges_.of(piece);
      oriented.push_back(records_.add(fmt::format("ORIENTED_EDGE('',*,*,#{},.{}.)", edge, back ? 'F' : 'T')));
    }
    return records_.add("EDGE_LOOP(''," + list_of(oriented) + ")");
  }

  /// A loop (508) of a B-rep, whose edges are shared: their number, and of each whether it is an edge or a vertex, its
  /// list, its place there, whether it runs along it, and its curves in parameters.
  Expected<int> add_shared_loop(const Parameters& parameters, const Eigen::Affine3d& move) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    Ids oriented;
    int pole = 0;
    std::size_t at = 2;
    for (int n = pointer(1); n > 0 && at + 4 < values.size(); --n) {
      if (pointer(at) == 1) {
        pole = shared_vertex(pointer(at + 1), pointer(at + 2), move);
      } else {
        const auto edge = shared_edge(pointer(at + 1), pointer(at + 2), move);
        if (!edge) return std::unexpected(edge.error());
        oriented.push_back(
            records_.add(fmt::format("ORIENTED_EDGE('',*,*,#{},.{}.)", *edge, pointer(at + 3) != 0 ? 'T' : 'F')));
      }
      at += 5 + 2 * static_cast<std::size_t>(std::max(pointer(at + 4), 0));
    }
    if (!oriented.empty()) return records_.add("EDGE_LOOP(''," + list_of(oriented) + ")");
    return pole != 0 ? records_.add(fmt::format("VERTEX_LOOP('',#{})", pole)) : 0;
  }

  int shared_vertex(int list, int index, const Eigen::Affine3d& move) {
    const auto [found, added] = shared_vertices_.try_emplace({list, index}, 0);
    if (!added) return found->second;
    const auto parameters = vertex_list(list);
    Point p = Point::Zero();
    if (index >= 1 && 3 * static_cast<std::size_t>(index) <= parameters.size()) {
      const double* own = &parameters[3 * static_cast<std::size_t>(index - 1)];
      p = move * Point(own[0], own[1], own[2]);
    }
    found->second = records_.vertex(p);
    edges_.add_vertex(found->second, {list, index, move});
    return found->second;
  }

  /// The coordinates of a vertex list (502), read once.
  const std::vector<double>& vertex_list(int list) {
    const auto [found, added] = vertex_lists_.try_emplace(list);
    const auto parameters = added ? file_.parameters(list) : Expected<Parameters>(input_error(""));
    if (parameters && parameters->values.size() > 2) {
      const std::size_t count = (parameters->values.size() - 2) / 3;
      if (auto all = numbers(file_, list, *parameters, 2, 3 * count)) found->second = *std::move(all);
    }
    return found->second;
  }

  /// Entry of an edge list (504): curve, and list and place of the vertices at its ends.
  Expected<int> shared_edge(int list, int index, const Eigen::Affine3d& move) {
    const auto [found, added] = shared_edges_.try_emplace({list, index}, 0);
    if (!added) return found->second;
    const auto [lists, fresh] = edge_lists_.try_emplace(list);
    const auto parameters = fresh ? file_.parameters(list) : Expected<Parameters>(input_error(""));
    if (parameters) {
      for (const std::string& value : parameters->values) lists->second.push_back(integer(value).value_or(0));
    }
    const Ids& own = lists->second;
    const std::size_t at = 2 + 5 * static_cast<std::size_t>(std::max(index, 1) - 1);
    if (at + 5 > own.size()) return file_.error(list, fmt::format("it has no edge {}", index), "get the whole file");
    std::vector<Piece> pieces;
    if (auto done = curves_.add(own[at], move, pieces); !done) return std::unexpected(done.error());
    const int from = shared_vertex(own[at + 1], own[at + 2], move), to = shared_vertex(own[at + 3], own[at + 4], move);
    if (pieces.size() != 1) {
      pieces.assign(1, Piece{});
      pieces[0].number = own[at];
      pieces[0].in_space = false;
      pieces[0].geometry = records_.add(fmt::format("IGES_CURVE_102('D{}')", own[at]));
    }
    return shared_edges_[{list, index}] = edges_.add(pieces[0], from, to);
  }

  const File& file_;
  StepRecords records_;
  CurveReader curves_;
  std::set<int> turned_;
  Edges edges_;
  StepView view_;
  std::map<int, Eigen::Affine3d> outer_;
  std::unordered_map<int, Surface> splines_;
  std::set<int> surfaces_, shown_;
  std::map<std::pair<int, int>, int> shared_vertices_, shared_edges_;
  std::map<int, std::vector<double>> vertex_lists_;
  std::map<int, Ids> edge_lists_;
};

}  // namespace

StepView step_view(const File& file) { return ViewBuilder(file).build(); }

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
