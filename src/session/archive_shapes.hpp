#pragma once

#include "archive_state.hpp"

namespace knead::archive {

template <int D>
void write_spline(Writer& a, const Spline<D>& spline) {
  for (const KnotVector& knots : spline.knots()) pass(a, knots);
  a.points(spline.control_points());
  a.numbers({spline.weights().begin(), spline.weights().end()});
}

template <int D>
std::shared_ptr<const Spline<D>> read_spline(Reader& a) {
  auto knots = read_all_knots<D>(a);
  Points points;
  std::vector<double> weights;
  a.points(points);
  a.numbers(weights);
  if (a.bad() || !knots) return nullptr;
  auto made = Spline<D>::create(*std::move(knots), std::move(points), std::move(weights));
  if (!made) a.fail();
  return made ? std::make_shared<const Spline<D>>(*std::move(made)) : nullptr;
}

/// The splines of a shape, each written where it first appears. Surfaces are those of the whole session.
template <int D>
class Splines {
 public:
  void pass(Writer& a, const std::shared_ptr<const Spline<D>>& x) {
    if constexpr (D == 2) return a.surface(x);
    const auto k = static_cast<std::size_t>(std::ranges::find(known_, x) - known_.begin());
    a.count(k);
    if (k < known_.size()) return;
    known_.push_back(x);
    write_spline<D>(a, *x);
  }
  void pass(Reader& a, std::shared_ptr<const Spline<D>>& x) {
    if constexpr (D == 2) return a.surface(x);
    std::size_t k = 0;
    a.count(k);
    if (a.bad() || k > known_.size()) return a.fail();
    if (k == known_.size()) known_.push_back(read_spline<D>(a));
    x = known_[k];
  }

 private:
  std::vector<std::shared_ptr<const Spline<D>>> known_;
};

template <int D>
void pass_constraint(Writer& a, const ConstraintOf<D>& x) {
  a.text(to_json(restated<D>(x)));
}
template <int D>
void pass_constraint(Reader& a, ConstraintOf<D>& x) {
  std::string json;
  a.text(json);
  if (a.bad()) return;
  const auto parsed = parse_command(json);
  auto constraint = parsed ? constraint_of<D>(*parsed) : std::nullopt;
  if (!constraint) return a.fail();
  x = *std::move(constraint);
}

template <class A>
void pass(A& a, Of<A, FormWeights>& w) {
  pass(a, w.w1);
  pass(a, w.w2);
}

template <class A, std::size_t D>
void pass_pins(A& a, Of<A, std::set<std::array<int, D>>>& pins) {
  if constexpr (A::writing) {
    a.count(pins.size());
    for (const auto& pin : pins) {
      for (const int i : pin) a.integer(i);
    }
  } else {
    for (std::size_t k = a.length(4 * D); k > 0; --k) {
      std::array<int, D> pin{};
      for (int& i : pin) a.integer(i);
      pins.insert(pin);
    }
  }
}

template <class A>
void pass(A& a, Of<A, SurfaceOwn>& s) {
  auto& [smooth_knot_lines, smooth_poles, plastic, mask, visible] = s;
  pass(a, smooth_knot_lines);
  pass(a, smooth_poles);
  if constexpr (!A::writing) {
    visible.reset();  // the document provides it
    plastic = {};
    mask.clear();
  }
  auto& [along, share, yield, locality, in_radii] = plastic;
  pass(a, along);
  for (auto* x : {&share, &yield, &locality}) pass(a, *x);
  pass(a, in_radii);
  pass(a, mask);
}

template <class A, int D>
void pass_shape(A& a, Of<A, SceneShape<D>>& s) {
  auto& [id, name, unit, velocity, mode, hold_rows] = static_cast<Of<A, ShapeCommon>&>(s);
  auto& [opened, reference, rest, current, material, elasticity, pins, constraints] =
      static_cast<Of<A, ShapeOf<D>>&>(s);
  Splines<D> splines;
  for (auto* x : {&id, &name, &unit}) pass(a, *x);
  for (auto* x : {&opened, &reference, &rest, &current}) splines.pass(a, *x);
  pass(a, velocity);
  choice(a, mode, RestMode::none);
  for (auto& x : material.alpha) pass_coefficient<D>(a, x);
  for (auto& x : material.beta) pass_coefficient<D>(a, x);
  pass_coefficient<D>(a, material.mass);
  pass_coefficient<D>(a, material.damping);
  pass(a, hold_rows);
  pass_pins<A, D>(a, pins);
  if constexpr (A::writing) {
    a.count(constraints.size());
  } else {
    constraints.resize(a.length(4));
  }
  for (auto& [constraint, where] : constraints) {
    pass_constraint<D>(a, constraint);
    splines.pass(a, where);
  }
  if constexpr (D == 2) {
    pass(a, static_cast<Of<A, SurfaceOwn>&>(s));
    alternative<ShellMaterial>(a, elasticity);
    alternative<FundamentalMaterial>(a, elasticity);
  } else {
    alternative<FormWeights>(a, elasticity);
  }
}

template <class A>
void pass(A& a, Of<A, SceneSurface>& s) {
  pass_shape<A, 2>(a, s);
}

template <class A>
void pass(A& a, Of<A, SceneBody>& body) {
  bool curve = body.index() == 0;
  pass(a, curve);
  if constexpr (!A::writing) {
    if (!curve) body = SceneVolume();
  }
  if (curve) {
    pass_shape<A, 1>(a, std::get<SceneCurve>(body));
  } else {
    pass_shape<A, 3>(a, std::get<SceneVolume>(body));
  }
}

/// Whether what is read of a curve or volume fits its net.
inline bool fits(const SceneBody& body) {
  return std::visit(
      [](const auto& s) {
        const auto net = s.current->net();
        const auto on_net = [&](const auto& spline) { return spline->net() == net; };
        for (const auto& pin : s.pins) {
          for (std::size_t d = 0; d < net.size(); ++d) {
            if (pin[d] < 0 || pin[d] >= net[d]) return false;
          }
        }
        return on_net(s.opened) && on_net(s.reference) && on_net(s.rest) &&
               std::ranges::all_of(s.constraints, [&](const auto& kept) { return on_net(kept.where); }) &&
               (s.velocity.rows() == 0 || s.velocity.rows() == s.current->size());
      },
      body);
}

}  // namespace knead::archive
