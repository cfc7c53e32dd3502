#pragma once

#include <type_traits>
#include <variant>

#include "described_archive.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/session.hpp"
#include "knead/tool/describe_shape.hpp"
#include "restated.hpp"

// One function per type that lists its members, for writing and for reading. Structured bindings name all members:
// adding one does not compile until it is listed here too.

namespace knead::archive {

template <class A, class T>
using Of = std::conditional_t<A::writing, const T, T>;

template <class A>
void pass(A& a, Of<A, double>& x) {
  a.number(x);
}
template <class A>
void pass(A& a, Of<A, int>& x) {
  a.integer(x);
}
template <class A>
void pass(A& a, Of<A, bool>& x) {
  a.flag(x);
}
template <class A>
void pass(A& a, Of<A, std::string>& x) {
  a.text(x);
}
template <class A>
void pass(A& a, Of<A, std::vector<double>>& x) {
  a.numbers(x);
}
template <class A>
void pass(A& a, Of<A, Points>& x) {
  a.points(x);
}
template <class A>
void pass(A& a, Of<A, std::shared_ptr<const Surface>>& x) {
  a.surface(x);
}

/// Enumerations as integers, 0 to `last`.
template <class A, class E>
void choice(A& a, E& x, std::remove_const_t<E> last) {
  int value = static_cast<int>(x);
  a.integer(value);
  if constexpr (!A::writing) {
    if (value < 0 || value > static_cast<int>(last)) return a.fail();
    x = static_cast<E>(value);
  }
}

template <class A, class T>
void optional(A& a, T& x) {
  bool present = x.has_value();
  a.flag(present);
  if constexpr (!A::writing) {
    if (present && !a.bad()) x.emplace();
  }
  if (x) pass(a, *x);
}

/// One kind of a variant, where it is the one there.
template <class T, class A, class V>
void alternative(A& a, V& x) {
  bool present = std::holds_alternative<T>(x);
  a.flag(present);
  if constexpr (!A::writing) {
    if (present && !a.bad()) x = T{};
  }
  if (auto* held = std::get_if<T>(&x)) pass(a, *held);
}

/// A list of items of at least `least` bytes each.
template <class A, class T>
void list(A& a, T& x, std::size_t least = 4) {
  if constexpr (A::writing) {
    a.count(x.size());
  } else {
    x.resize(a.length(least));
  }
  for (std::size_t k = 0; k < x.size(); ++k) pass(a, x[k]);
}

/// The content of a command, as the JSON form of that command, which parses back to the same.
template <class C, class T>
void command(Writer& a, const T& x) {
  a.text(to_json(x));
}
template <class C, class T>
void command(Reader& a, T& x) {
  std::string json;
  a.text(json);
  if (a.bad()) return;
  const auto parsed = parse_command(json);
  const C* const fields = parsed ? fields_of<C>(*parsed) : nullptr;
  if (fields == nullptr) return a.fail();
  const auto& [value] = *fields;
  x = value;
}

template <class A>
void pass(A& a, Of<A, FundamentalMaterial>& m) {
  auto& [w1, w2] = m;
  for (auto& w : w1) pass(a, w);
  for (auto& w : w2) pass(a, w);
}

template <class A>
void pass(A& a, Of<A, ModeRecord>& m) {
  auto& [value, residual, shape] = m;
  pass(a, value);
  pass(a, residual);
  pass(a, shape);
}

template <class A>
void pass(A& a, Of<A, StepRecord>& s) {
  auto& [surface, time, energy, stretch, bend, kinetic, contact, residual, largest_displacement, gap, violation,
         iterations, converged, limited, note, load_factor, increments, energy_error] = s;
  pass(a, surface);
  for (auto* x :
       {&time, &energy, &stretch, &bend, &kinetic, &contact, &residual, &largest_displacement, &gap, &violation}) {
    pass(a, *x);
  }
  pass(a, iterations);
  pass(a, converged);
  pass(a, limited);
  pass(a, note);
  if constexpr (!A::writing) {
    load_factor.reset();
    increments.clear();
    energy_error.reset();
  }
  optional(a, load_factor);
  list(a, increments);
  optional(a, energy_error);
}

}  // namespace knead::archive
