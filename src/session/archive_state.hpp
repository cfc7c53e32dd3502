#pragma once

#include "archive_parts.hpp"
#include "knead/spline/extremum.hpp"

namespace knead::archive {

template <class A>
void pass(A& a, Of<A, PatchEdge>& e) {
  pass(a, e.patch);
  choice(a, e.edge, SurfaceEdge::v1);
}

template <class A>
void pass(A& a, Of<A, SeamReport>& r) {
  auto& [seam, continuity, reason, rigid, restricted, mismatch, angle, ratio, deviation, constraints] = r;
  auto& [first, second, reversed, kind, gap] = seam;
  pass(a, first);
  pass(a, second);
  pass(a, reversed);
  choice(a, kind, SeamKind::partial);
  pass(a, gap);
  choice(a, continuity, SeamContinuity::periodic);
  pass(a, reason);
  pass(a, rigid);
  pass(a, restricted);
  for (auto* x : {&mismatch, &angle, &ratio, &deviation}) pass(a, *x);
  pass(a, constraints);
}

inline void pass(Writer& a, const KnotVector& x) {
  a.integer(x.degree());
  a.numbers({x.knots().begin(), x.knots().end()});
}
inline std::optional<KnotVector> read_knots(Reader& a) {
  int degree = 0;
  std::vector<double> knots;
  a.integer(degree);
  a.numbers(knots);
  if (a.bad()) return std::nullopt;
  auto made = KnotVector::create(degree, std::move(knots));
  if (!made) a.fail();
  return made ? std::optional(std::move(*made)) : std::nullopt;
}

template <int D>
std::optional<std::array<KnotVector, D>> read_all_knots(Reader& a) {
  std::vector<KnotVector> knots;
  for (int d = 0; d < D; ++d) {
    auto read = read_knots(a);
    if (!read) return std::nullopt;
    knots.push_back(*std::move(read));
  }
  return [&]<std::size_t... d>(std::index_sequence<d...>) { return std::array<KnotVector, D>{std::move(knots[d])...}; }
  (std::make_index_sequence<D>());
}

template <int D>
void pass_coefficient(Writer& a, const Coefficient<D>& x) {
  const auto* field = std::get_if<SplineField<D>>(&x);
  a.flag(field != nullptr);
  if (field == nullptr) return a.number(std::get<double>(x));
  for (const KnotVector& knots : field->knots()) pass(a, knots);
  a.numbers(field->coefficients());
}
template <int D>
void pass_coefficient(Reader& a, Coefficient<D>& x) {
  bool varies = false;
  a.flag(varies);
  if (!varies) return a.number(x.template emplace<double>());
  auto knots = read_all_knots<D>(a);
  std::vector<double> coefficients;
  a.numbers(coefficients);
  if (!knots || a.bad()) return a.fail();
  auto made = SplineField<D>::create(*std::move(knots), std::move(coefficients));
  if (!made) return a.fail();
  x = std::move(*made);
}

inline void pass(Writer& a, const std::optional<SplineField<2>>& x) {
  pass_coefficient<2>(a, x ? Coefficient<2>(*x) : Coefficient<2>(0.0));
}
inline void pass(Reader& a, std::optional<SplineField<2>>& x) {
  Coefficient<2> read = 0.0;
  pass_coefficient<2>(a, read);
  x.reset();
  if (auto* field = std::get_if<SplineField<2>>(&read)) x = std::move(*field);
}

template <class A>
void pass(A& a, Of<A, ShellMaterial>& m) {
  auto& [young, poisson, thickness, density, young_field, thickness_field] = m;
  for (auto* x : {&young, &poisson, &thickness, &density}) pass(a, *x);
  if constexpr (!A::writing) {
    young_field.reset();
    thickness_field.reset();
  }
  pass(a, young_field);
  pass(a, thickness_field);
}

inline void pass(Writer& a, const SceneForce& f) {
  a.text(to_json(f));
  a.integer(f.surface);
  a.integer(f.body);
}
inline void pass(Reader& a, SceneForce& f) {
  std::string json;
  a.text(json);
  a.integer(f.surface);
  a.integer(f.body);
  if (a.bad()) return;
  const auto parsed = parse_command(json);
  const auto* fields = parsed ? fields_of<ForceCommand>(*parsed) : nullptr;
  if (fields == nullptr) return a.fail();
  auto force = force_of(*fields);
  if (!force) return a.fail();
  f.name = fields->name;
  f.force = *std::move(force);
}

template <class A>
void pass(A& a, Of<A, Probe>& p) {
  auto& [name_of_list, name, surface, at] = p;
  pass(a, name_of_list);
  pass(a, name);
  pass(a, surface);
  for (auto& x : at) pass(a, x);
}

template <class A>
void pass(A& a, Of<A, Point>& p) {
  for (Eigen::Index k = 0; k < 3; ++k) pass(a, p[k]);
}

template <class A>
void pass(A& a, Of<A, OpenStroke::Before>& b) {
  pass(a, b.rest);
  pass(a, b.current);
}

template <class A>
void pass(A& a, Of<A, OpenStroke>& s) {
  auto& [tool, home, path, lambda, stiffness, tension, plasticity, before, history, last, share] = s;
  pass(a, tool);
  pass(a, home);
  pass(a, path.spacing);
  pass(a, path.rest);
  pass(a, path.end);
  pass(a, path.begun);
  for (auto* x : {&lambda, &stiffness, &tension, &plasticity.share, &plasticity.yield}) pass(a, *x);
  list(a, before, 16);
  for (auto* x : {&history, &last}) pass(a, *x);
  pass(a, share);
}

template <class A>
void pass(A& a, Of<A, BrushImage>& i) {
  auto& [linear, offset] = i;
  for (Eigen::Index k = 0; k < 9; ++k) pass(a, linear.data()[k]);
  pass(a, offset);
}

template <class A>
void pass(A& a, Of<A, Fractions>& f) {
  for (auto& x : f) pass(a, x);
}

template <class A>
void pass(A& a, Of<A, BrushPoint>& p) {
  pass(a, p.surface);
  pass(a, p.at);
  pass(a, p.pen.pressure);
  pass(a, p.pen.axis);
}

inline void path(Writer& a, const SharedList<BrushPoint>& path) { list(a, path, 20); }
inline void path(Reader& a, SharedList<BrushPoint>& path) {
  path = {};
  std::vector<BrushPoint> points;
  list(a, points, 20);
  for (const BrushPoint& at : points) path.push_back(at);
}

template <class A>
void pass(A& a, Of<A, OpenBrush>& b) {
  auto& [brush, images, rope, points, before, masks] = b;
  auto& [kind, radius, height, strength, core, by, angle, factor, pattern, pressure] = brush;
  choice(a, kind, BrushKind::stamp);
  for (auto* x : {&radius, &height, &strength, &core, &angle, &factor, &rope}) pass(a, *x);
  pass(a, by);
  if (kind == BrushKind::stamp) {
    auto& [columns, heights] = pattern;
    pass(a, columns);
    a.numbers(heights);
    if constexpr (!A::writing) {
      if (columns < 2 || heights.size() < 4 || heights.size() % static_cast<std::size_t>(columns) != 0) a.fail();
    }
  }
  list(a, images, 96);
  path(a, points);
  list(a, before, 16);
  list(a, masks, 8);
  choice(a, pressure, PressureUse::none);
}

template <class A>
void pass(A& a, Of<A, PulledLattice>& l) {
  auto& [net, degree, margin, points, surfaces, before, after] = l;
  for (auto* three : {&net, &degree}) {
    for (auto& x : *three) pass(a, x);
  }
  pass(a, margin);
  pass(a, points);
  list(a, surfaces);
  list(a, before, 8);
  list(a, after, 8);
}

/// Whether a lattice has the control points that its net says, and a shape before and after of each of its surfaces.
inline bool is_whole(const PulledLattice& lattice) {
  double count = 1;
  for (const int n : lattice.net) count *= n;
  if (static_cast<double>(lattice.points.rows()) != count || !lattice.points.allFinite()) return false;
  const std::size_t surfaces = lattice.surfaces.size();
  if (lattice.before.size() != surfaces || lattice.after.size() != surfaces) return false;
  for (std::size_t k = 0; k < surfaces; ++k) {
    if (!same_basis(*lattice.before[k], *lattice.after[k])) return false;
  }
  return surfaces > 0;
}

template <class A>
void pass(A& a, Of<A, Placement>& p) {
  auto& [rotation, position, scale] = p;
  for (Eigen::Index k = 0; k < 4; ++k) pass(a, rotation.coeffs()[k]);
  for (Eigen::Index k = 0; k < 3; ++k) pass(a, position[k]);
  for (auto& x : scale) pass(a, x);
}

inline void pass(Writer& a, const Tool& t) {
  const auto& [name, shape, mode, stiffness, range, rigid, friction, plasticity, direction, touches] = t;
  a.text(name);
  write(a, type_of<Shape>(), &shape.shape());
  pass(a, shape.placement());
  choice(a, mode, ToolMode::imprint);
  for (const double* x : {&stiffness, &range, &friction, &plasticity}) a.number(*x);
  a.flag(rigid);
  choice(a, direction, ToolDirection::push);
  choice(a, touches, ToolTouch::visible);
}
inline std::optional<Tool> read_tool(Reader& a) {
  std::string name;
  a.text(name);
  Shape shape;
  read(a, type_of<Shape>(), &shape);
  Placement at;
  pass(a, at);
  if (a.bad()) return std::nullopt;
  auto placed = PlacedShape::create(shape, at);
  if (!placed) {
    a.fail();
    return std::nullopt;
  }
  Tool t{.name = std::move(name), .shape = std::move(*placed)};
  choice(a, t.mode, ToolMode::imprint);
  for (double* x : {&t.stiffness, &t.range, &t.friction, &t.plasticity}) a.number(*x);
  a.flag(t.rigid);
  choice(a, t.direction, ToolDirection::push);
  choice(a, t.touches, ToolTouch::visible);
  return t;
}

}  // namespace knead::archive
