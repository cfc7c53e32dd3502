#pragma once

#include <string>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::brep {

/// Adds an entity to a model, and returns where it is.
Index add_vertex(Model& model, std::string id, const Point& place);
Index add_edge(Model& model, std::string id, Index start, Index end, Expected<CurveGeometry> curve);

/// Makes the model of a format that counts its entities. Entity n is "#n"; those that the format
/// does not count have numbers above.
class ModelBuilder {
 public:
  /// \param last the largest number that the format gives itself
  ModelBuilder(std::string file, int last) : next_(last + 1) { model_.name = std::move(file); }

  [[nodiscard]] static std::string name(int number) { return "#" + std::to_string(number); }
  [[nodiscard]] int fresh() { return next_++; }
  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] Model& model() { return model_; }

  Index add_vertex(int number, const Point& place) {
    return brep::add_vertex(model_, name(number), place);
  }
  Index add_edge(int number, Index start, Index end, Expected<CurveGeometry> curve) {
    return brep::add_edge(model_, name(number), start, end, std::move(curve));
  }
  Index add_support(Support support);
  /// With the support that leads to it.
  Index add_surface(int number, std::string label, Surface surface, const std::string& unit,
                    double uncertainty);
  void add_face(Face face) { model_.faces.push_back(std::move(face)); }
  void add_shell(Shell shell) { model_.shells.push_back(std::move(shell)); }
  void add_unreadable(int number, Error reason) {
    model_.unreadable.push_back({name(number), std::move(reason)});
  }

  /// The B-spline surface that a support leads to, or null.
  [[nodiscard]] const SplineSurface* spline_at(Index support) const {
    const Index spline = support == none ? none : model_.supports[support].spline;
    return spline == none ? nullptr : &model_.surfaces[spline];
  }

  /// \param unit of all lengths; "unknown" where there is none
  [[nodiscard]] Model complete(const std::string& unit, double metres) &&;

 private:
  Model model_;
  int next_;
};

/// Of edges where it has some, whose vertex bounds nothing; else of its vertex; else unknown.
void settle_kind(Bound& bound);

/// Fills what follows from the rest of a model: which of its surfaces are closed and trimmed, and
/// how many faces lie on each; an assembly of one part where it has none. Cost: some searches for
/// the nearest point of a side per span of every edge, by several threads where there is much to
/// do.
void complete(Model& model);

}  // namespace knead::brep
