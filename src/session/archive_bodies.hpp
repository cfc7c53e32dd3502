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
  std::vector<KnotVector> knots;
  for (int d = 0; d < D; ++d) {
    auto read = read_knots(a);
    if (!read) return nullptr;
    knots.push_back(*std::move(read));
  }
  Points points;
  std::vector<double> weights;
  a.points(points);
  a.numbers(weights);
  if (a.bad()) return nullptr;
  auto made = [&]<std::size_t... d>(std::index_sequence<d...>) {
    return Spline<D>::create({std::move(knots[d])...}, std::move(points), std::move(weights));
  }
  (std::make_index_sequence<D>());
  if (!made) a.fail();
  return made ? std::make_shared<const Spline<D>>(*std::move(made)) : nullptr;
}

/// The shapes of a body: each different one, then which of them each is.
template <class A, int D>
void pass_shapes(A& a, Of<A, BodyShapes<D>>& shapes) {
  std::array roles = {&shapes.opened, &shapes.reference, &shapes.rest, &shapes.current};
  std::vector<std::shared_ptr<const Spline<D>>> made;
  if constexpr (A::writing) {
    for (const auto* role : roles) {
      if (std::ranges::find(made, *role) == made.end()) made.push_back(*role);
    }
    a.count(made.size());
    for (const auto& spline : made) write_spline<D>(a, *spline);
    for (const auto* role : roles) a.integer(static_cast<int>(std::ranges::find(made, *role) - made.begin()));
  } else {
    for (std::size_t k = a.length(8); k > 0 && !a.bad(); --k) made.push_back(read_spline<D>(a));
    for (auto* role : roles) {
      int k = 0;
      a.integer(k);
      if (a.bad() || k < 0 || k >= static_cast<int>(made.size())) return a.fail();
      *role = made[static_cast<std::size_t>(k)];
    }
    for (auto* role : roles) {
      if ((*role)->net() != shapes.current->net()) return a.fail();
    }
  }
  for (auto& x : shapes.material.alpha) pass(a, x);
  for (auto& x : shapes.material.beta) pass(a, x);
}

template <class A>
void pass(A& a, Of<A, Components>& c) {
  for (auto& x : c) pass(a, x);
}

template <class A>
void pass(A& a, Of<A, SideHold>& h) {
  pass(a, h.side.direction);
  pass(a, h.side.upper);
  pass(a, h.order);
  pass(a, h.components);
}

template <class A>
void pass(A& a, Of<A, PlacePin>& p) {
  pass(a, p.at);
  bool moved = p.to.has_value();
  pass(a, moved);
  if constexpr (!A::writing) {
    if (moved && !a.bad()) p.to.emplace();
  }
  if (p.to) {
    for (auto& x : *p.to) pass(a, x);
  }
  pass(a, p.components);
}

template <class A>
void pass(A& a, Of<A, KeptBodyHold>& kept) {
  bool side = std::holds_alternative<SideHold>(kept.hold);
  pass(a, side);
  if constexpr (!A::writing) {
    if (side) {
      kept.hold = SideHold{};
    } else {
      kept.hold = PlacePin{};
    }
  }
  std::visit([&a](auto& hold) { pass(a, hold); }, kept.hold);
  pass(a, kept.where);
}

template <class A>
void pass(A& a, Of<A, FormWeights>& w) {
  pass(a, w.w1);
  pass(a, w.w2);
}

template <class A>
void pass(A& a, Of<A, SceneBody>& b) {
  auto& [id, name, unit, shapes, velocity, mode, mass, damping, hold_rows, pins, holds] = b;
  for (auto* x : {&id, &name, &unit}) pass(a, *x);
  bool curve = b.is_curve();
  pass(a, curve);
  if constexpr (!A::writing) {
    if (curve) {
      shapes = BodyShapes<1>{};
    } else {
      shapes = BodyShapes<3>{};
    }
  }
  if (curve) {
    pass_shapes<A, 1>(a, std::get<BodyShapes<1>>(shapes));
  } else {
    pass_shapes<A, 3>(a, std::get<BodyShapes<3>>(shapes));
  }
  pass(a, velocity);
  choice(a, mode, RestMode::none);
  pass(a, mass);
  pass(a, damping);
  pass(a, hold_rows);
  if constexpr (A::writing) {
    a.count(pins.size());
    for (const int pin : pins) a.integer(pin);
  } else {
    pins.clear();
    for (std::size_t k = a.length(4); k > 0; --k) {
      int pin = 0;
      a.integer(pin);
      pins.insert(pin);
    }
  }
  list(a, holds, 8);
  if (older_than(a, 10)) return;  // which kept no forms
  std::visit([&a](auto& each) { alternative<FormWeights>(a, each.elasticity); }, shapes);
}

/// Whether what is read of a body fits its net.
inline bool fits(const SceneBody& body) {
  const int count = static_cast<int>(control_points_of(body).rows());
  const std::size_t directions = body.is_curve() ? 1 : 3;
  for (const int pin : body.pins) {
    if (pin < 0 || pin >= count) return false;
  }
  for (const auto& [hold, where] : body.holds) {
    if (where.rows() != count) return false;
    const auto* pin = std::get_if<PlacePin>(&hold);
    if (pin != nullptr && pin->at.size() != directions) return false;
  }
  return body.velocity.rows() == 0 || body.velocity.rows() == count;
}

}  // namespace knead::archive
