#pragma once

#include "commands.hpp"
#include "described_archive.hpp"
#include "diagnostic_info.hpp"
#include "restated.hpp"
#include "tool/describe_shape.hpp"

// Values of states that are kept in another form than they have, and lists that copies share.

namespace knead {
namespace kept {

/// A coefficient: a number, or a field with knots.
struct CoefficientForm {
  double value = 0;
  std::vector<KnotForm> knots;
  std::vector<double> coefficients;
};
inline void describe(CoefficientForm& c, Fields& fields) {
  fields.add_all("value", c.value, "knots", c.knots, "coefficients", c.coefficients);
}

template <int D>
CoefficientForm form_of(const Coefficient<D>& c) {
  const auto* const field = std::get_if<SplineField<D>>(&c);
  if (field == nullptr) return {std::get<double>(c), {}, {}};
  return {0, form_of<D>(field->knots()), field->coefficients()};
}
template <int D>
bool take(Coefficient<D>& c, CoefficientForm& form) {
  if (form.knots.empty()) {
    c = form.value;
    return true;
  }
  auto knots = knots_of<D>(std::move(form.knots));
  if (!knots) return false;
  auto field = SplineField<D>::create(*std::move(knots), std::move(form.coefficients));
  if (field) c = *std::move(field);
  return field.has_value();
}

inline CoefficientForm form_of(const std::optional<SplineField<2>>& field) {
  return field ? form_of<2>(Coefficient<2>(*field)) : CoefficientForm();
}
inline bool take(std::optional<SplineField<2>>& field, CoefficientForm& form) {
  Coefficient<2> c = 0.0;
  const bool taken = take<2>(c, form);
  field.reset();
  if (auto* made = std::get_if<SplineField<2>>(&c)) field = std::move(*made);
  return taken;
}

template <class E>
std::vector<E> form_of(const std::set<E>& items) {
  return {items.begin(), items.end()};
}
template <class E>
bool take(std::set<E>& items, std::vector<E>& form) {
  items = {form.begin(), form.end()};
  return true;
}

// Constraints and forces, by the commands that make them.

template <class... Kinds>
CommandVariant form_of(const std::variant<EdgeHold, Kinds...>& constraint) {
  return restated<2>(constraint).any().fields;
}
template <int D>
CommandVariant form_of(const std::variant<SideHold, PointPinOf<D>>& constraint) {
  return restated<D>(constraint).any().fields;
}
template <int D>
bool take_constraint(ConstraintOf<D>& constraint, CommandVariant& form) {
  auto made = constraint_of<D>(make_command(std::move(form)));
  if (made) constraint = *std::move(made);
  return made.has_value();
}
inline bool take(Constraint& constraint, CommandVariant& form) {
  return take_constraint<2>(constraint, form);
}
template <int D>
bool take(std::variant<SideHold, PointPinOf<D>>& constraint, CommandVariant& form) {
  return take_constraint<D>(constraint, form);
}

struct ForceForm {
  ForceCommand command;
  int surface = 0, body = -1;
};
inline void describe(ForceForm& f, Fields& fields) {
  fields.add_all("command", f.command, "surface", f.surface, "body", f.body);
}
inline ForceForm form_of(const SceneForce& force) {
  return {restated(force), force.surface, force.body};
}
inline bool take(SceneForce& force, ForceForm& form) {
  auto made = force_of(form.command);
  if (made) force = {std::move(form.command.name), form.surface, form.body, *std::move(made)};
  return made.has_value();
}

struct PlacedForm {
  Shape shape;
  Placement at;
};
inline void describe(PlacedForm& p, Fields& fields) {
  fields.add_flat(p.shape);
  fields.add_all("rotation", p.at.rotation.coeffs(), "position", p.at.position, "scale",
                 p.at.scale);
}
inline PlacedForm form_of(const PlacedShape& placed) {
  return {placed.shape(), placed.placement()};
}
inline bool take(PlacedShape& placed, PlacedForm& form) {
  auto made = PlacedShape::create(form.shape, form.at);
  if (made) placed = *std::move(made);
  return made.has_value();
}

inline NoteInfo form_of(const Note& note) {
  if (!note.diagnostic) return {note, {}, {}, {}};
  return {note, note.diagnostic->code, values_of(*note.diagnostic), {}};
}
inline bool take(Note& note, NoteInfo& form) {
  note = Note(std::move(form.text),
              {form.code, form.values ? named_values(*form.values) : std::vector<NamedValue>()});
  return true;
}

/// A type whose values are kept as those of another one: by `form_of` and `take`, or as its only
/// member.
template <class T, class Form, bool finite = true>
struct As {
  static std::shared_ptr<void> to(const void* v) {
    const T& value = *static_cast<const T*>(v);
    if constexpr (requires { form_of(value); }) return std::make_shared<Form>(form_of(value));
    if constexpr (!requires { form_of(value); }) return std::make_shared<Form>(Form{value});
  }
  static bool from(void* v, void* f) {
    T& value = *static_cast<T*>(v);
    Form& form = *static_cast<Form*>(f);
    if (finite && !all_finite(type_of<Form>(), f)) return false;
    if (!check_ranges(type_of<Form>(), f)) return false;
    if constexpr (requires { take(value, form); }) return take(value, form);
    if constexpr (!requires { take(value, form); }) {
      auto& [only] = form;
      value = std::move(only);
    }
    return true;
  }
  static Type make() {
    return {.kind = Kind::opaque, .form = &type_of<Form>(), .to_form = to, .from_form = from};
  }
};

}  // namespace kept

template <>
inline PlacedShape initial_of<PlacedShape>() {
  return *PlacedShape::create(SphereShape());
}
template <>
inline Tool initial_of<Tool>() {
  return {.shape = initial_of<PlacedShape>()};
}

namespace detail {

template <int D>
struct TypeMaker<std::variant<double, SplineField<D>>>
    : kept::As<Coefficient<D>, kept::CoefficientForm> {};
template <>
struct TypeMaker<std::optional<SplineField<2>>>
    : kept::As<std::optional<SplineField<2>>, kept::CoefficientForm> {};
template <class E>
struct TypeMaker<std::set<E>> : kept::As<std::set<E>, std::vector<E>> {};
template <>
struct TypeMaker<Load> : kept::As<Load, LoadCommand> {};
template <>
struct TypeMaker<EvolutionPolicy> : kept::As<EvolutionPolicy, EvolveCommand> {};
template <>
struct TypeMaker<SeamPolicy> : kept::As<SeamPolicy, SeamsCommand> {};
template <>
struct TypeMaker<ConstraintOf<1>> : kept::As<ConstraintOf<1>, CommandVariant> {};
template <>
struct TypeMaker<ConstraintOf<2>> : kept::As<ConstraintOf<2>, CommandVariant> {};
template <>
struct TypeMaker<ConstraintOf<3>> : kept::As<ConstraintOf<3>, CommandVariant> {};
template <>
struct TypeMaker<SceneForce> : kept::As<SceneForce, kept::ForceForm> {};
template <>
struct TypeMaker<PlacedShape> : kept::As<PlacedShape, kept::PlacedForm> {};
template <>
struct TypeMaker<Note> : kept::As<Note, NoteInfo, false> {};

template <class E>
struct TypeMaker<SharedItems<E>> {
  using Items = SharedItems<E>;
  static Type make() {
    return {.kind = Kind::list,
            .element = &type_of<E>(),
            .count = [](const void* v) { return as<Items>(v).size(); },
            .resize = [](void* v, std::size_t n) { as<Items>(v).resize(n); },
            .at = [](void* v, std::size_t k) -> void* { return &as<Items>(v)[k]; },
            .weight = sizeof(E),
            .shared_by = 1,
            .look = [](const void* v, std::size_t k) -> const void* { return &as<Items>(v)[k]; }};
  }
};
template <class E>
struct TypeMaker<SharedList<E>> {
  using List = SharedList<E>;
  static Type make() {
    return {.kind = Kind::list,
            .element = &type_of<E>(),
            .count = [](const void* v) { return as<List>(v).size(); },
            .resize =
                [](void* v, std::size_t n) {
                  auto& list = as<List>(v);
                  list.truncate(n);
                  while (list.size() < n) list.push_back({});
                },
            .at = [](void* v, std::size_t k) -> void* { return &as<List>(v).own(k); },
            .weight = sizeof(E),
            .shared_by = List::chunk,
            .look = [](const void* v, std::size_t k) -> const void* { return &as<List>(v)[k]; }};
  }
};

}  // namespace detail
}  // namespace knead
