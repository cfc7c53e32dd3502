#include "described_archive.hpp"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

using cbor::Major;

/// How many doubles, one beside the other, a value consists of; 0: not of these alone.
/// Values are written by their descriptions (`Type`), so that a field that is added to a state is
/// kept without a line here. Lists of doubles, at any depth of fixed arrays, are one string of
/// bytes: control points take a copy, not a call per number.
std::size_t doubles_in(const Type& type) {
  if (type.kind == Kind::number) return 1;
  return type.kind == Kind::array ? type.length * doubles_in(*type.element) : 0;
}

/// Calls f<D> for the type of pointers to splines of D directions.
template <class F>
auto with_directions(const Type& type, const F& f) {
  if (&type == &type_of<SplinePointer<1>>()) return f.template operator()<1>();
  if (&type == &type_of<SplinePointer<3>>()) return f.template operator()<3>();
  assert((&type == &type_of<SplinePointer<2>>()));
  return f.template operator()<2>();
}

const Type& held_type(const Type& variant, const void* value) {
  return *variant.variants[static_cast<std::size_t>(variant.value(value))];
}

/// Whether f(type, a's part, b's part) holds for all that two values directly consist of, which are
/// the same in number and kind.
template <class F>
bool all_parts(const Type& type, const void* a, const void* b, const F& f) {
  switch (type.kind) {
    case Kind::optional:
    case Kind::list:
    case Kind::array: {
      const std::size_t count = type.count(a);
      bool all = count == type.count(b);
      for (std::size_t k = 0; k < count && all; ++k)
        all = f(*type.element, type.part(a, k), type.part(b, k));
      return all;
    }
    case Kind::record:
      return std::ranges::all_of(type.fields,
                                 [&](const Field& x) { return f(*x.type, x.of(a), x.of(b)); });
    case Kind::variant:
      return type.value(a) == type.value(b) && f(held_type(type, a), type.part(a), type.part(b));
    default:
      return true;
  }
}

bool same_bits(const void* a, const void* b, std::size_t doubles) {
  return doubles == 0 || std::memcmp(a, b, doubles * sizeof(double)) == 0;
}

template <int D>
bool same_spline(const Spline<D>& a, const Spline<D>& b) {
  return a.knots() == b.knots() && a.weights().size() == b.weights().size() &&
         a.size() == b.size() &&
         same_bits(a.weights().data(), b.weights().data(), a.weights().size()) &&
         same_bits(a.control_points().data(), b.control_points().data(),
                   3 * static_cast<std::size_t>(a.size()));
}

bool same_opaque(const Type& type, const void* a, const void* b, bool deep) {
  if (type.form != nullptr)
    return same(*type.form, type.to_form(a).get(), type.to_form(b).get(), deep);
  const void *const x = type.shared(a), *const y = type.shared(b);
  return x == y || (deep && with_directions(type, [&]<int D>() {
                      return same_spline<D>(*static_cast<const Spline<D>*>(x),
                                            *static_cast<const Spline<D>*>(y));
                    }));
}

}  // namespace

void describe(KnotForm& k, Fields& fields) { fields.add_all("degree", k.degree, "knots", k.knots); }
void describe(SplineForm& s, Fields& fields) {
  fields.add_all("knots", s.knots, "points", s.points, "weights", s.weights);
}

template <int D>
std::optional<std::array<KnotVector, D>> knots_of(std::vector<KnotForm>&& form) {
  std::vector<KnotVector> knots;
  for (KnotForm& k : form) {
    auto made = KnotVector::create(k.degree, std::move(k.knots));
    if (made) knots.push_back(*std::move(made));
  }
  if (knots.size() != form.size() || knots.size() != D) return std::nullopt;
  return [&]<std::size_t... d>(std::index_sequence<d...>) {
    return std::array<KnotVector, D>{std::move(knots[d])...};
  }
  (std::make_index_sequence<D>());
}

template std::optional<std::array<KnotVector, 1>> knots_of<1>(std::vector<KnotForm>&&);
template std::optional<std::array<KnotVector, 2>> knots_of<2>(std::vector<KnotForm>&&);
template std::optional<std::array<KnotVector, 3>> knots_of<3>(std::vector<KnotForm>&&);

bool same(const Type& type, const void* a, const void* b, bool deep) {
  if (a == b) return true;
  switch (type.kind) {
    case Kind::boolean:
      return *static_cast<const bool*>(a) == *static_cast<const bool*>(b);
    case Kind::integer:
      return *static_cast<const int*>(a) == *static_cast<const int*>(b);
    case Kind::number:
      return same_bits(a, b, 1);
    case Kind::text:
      return *static_cast<const std::string*>(a) == *static_cast<const std::string*>(b);
    case Kind::choice:
      return type.value(a) == type.value(b);
    case Kind::opaque:
      return same_opaque(type, a, b, deep);
    default:
      if (const std::size_t n =
              type.element != nullptr ? doubles_in(*type.element) * type.count(a) : 0;
          n > 0) {
        return type.count(b) == type.count(a) && same_bits(type.part(a), type.part(b), n);
      }
      return all_parts(type, a, b, [deep](const Type& t, const void* x, const void* y) {
        return same(t, x, y, deep);
      });
  }
}

bool all_finite(const Type& type, const void* value) {
  if (type.kind == Kind::number) return std::isfinite(*static_cast<const double*>(value));
  return all_parts(type, value, value,
                   [](const Type& t, const void* x, const void*) { return all_finite(t, x); });
}

std::size_t Weight::of(const Type& type, const void* value) {
  if (type.kind == Kind::text) return static_cast<const std::string*>(value)->size();
  std::size_t sum = 0;
  if (type.kind == Kind::opaque) {
    if (type.form != nullptr) return of(*type.form, type.to_form(value).get());
    const void* const object = type.shared(value);
    if (object == nullptr || !seen_.insert(object).second) return 0;
    return with_directions(type, [&]<int D>() {
      const Spline<D>& spline = *static_cast<const Spline<D>*>(object);
      for (const KnotVector& knots : spline.knots()) sum += knots.knots().size();
      return sizeof(double) *
             (sum + static_cast<std::size_t>(spline.size()) * (spline.rational() ? 4 : 3));
    });
  }
  if (type.shared_by > 0) return of_shared(type, value);
  if (type.element != nullptr) sum = type.count(value) * type.weight;
  if (type.element != nullptr && doubles_in(*type.element) > 0) return sum;
  all_parts(type, value, value, [&](const Type& t, const void* part, const void*) {
    sum += of(t, part);
    return true;
  });
  return sum;
}

std::size_t Weight::of_shared(const Type& list, const void* value) {
  const std::size_t count = list.count(value);
  std::size_t sum = 0;
  for (std::size_t k = 0; k < count; k += list.shared_by) {
    sum += sizeof(std::shared_ptr<void>);
    if (!seen_.insert(list.part(value, k)).second) continue;
    const std::size_t end = std::min(count, k + list.shared_by);
    for (std::size_t j = k; j < end; ++j)
      sum += list.weight + of(*list.element, list.part(value, j));
  }
  return sum;
}

// --- writing
// -----------------------------------------------------------------------------------------------

void StateWriter::write(const Type& type, const void* value, const void* other) {
  switch (type.kind) {
    case Kind::boolean:
      return simple(*static_cast<const bool*>(value) ? cbor::yes : cbor::no);
    case Kind::integer:
      return integer(*static_cast<const int*>(value));
    case Kind::number:
      return number(*static_cast<const double*>(value));
    case Kind::text:
      return text(*static_cast<const std::string*>(value));
    case Kind::choice:
      return name(type.choice(type.value(value))->name);
    case Kind::optional:
      if (type.count(value) == 0) return simple(cbor::null);
      return write(*type.element, type.part(value),
                   type.count(other) > 0 ? type.part(other) : type.element->initial);
    case Kind::list:
    case Kind::array:
      return write_list(type, value, other);
    case Kind::record: {
      std::vector<const Field*> changed;
      for (const Field& field : type.fields) {
        if (!same(*field.type, field.of(value), field.of(other))) changed.push_back(&field);
      }
      head(Major::map, changed.size());
      for (const Field* field : changed) {
        name(field->name);
        write(*field->type, field->of(value), field->of(other));
      }
      return;
    }
    case Kind::variant: {
      const Type& held = held_type(type, value);
      head(Major::map, 1);
      name(held.name);
      return write(held, type.part(value),
                   type.value(value) == type.value(other) ? type.part(other) : held.initial);
    }
    case Kind::opaque:
      return write_opaque(type, value, other);
  }
}

//   [k, item, undefined, item, …]
// The first k items are as in the value before, and so is each `undefined`. Lists of a history
// mostly grow at their end.
void StateWriter::write_list(const Type& type, const void* value, const void* other) {
  const Type& element = *type.element;
  const std::size_t count = type.count(value), known = std::min(count, type.count(other));
  if (const std::size_t doubles = doubles_in(element); doubles > 0) {
    return bytes(count > 0 ? type.part(value) : nullptr, 8 * doubles * count);
  }
  const auto as_before = [&](std::size_t k) {
    return k < known && same(element, type.part(value, k), type.part(other, k));
  };
  std::size_t first = 0;
  while (as_before(first)) ++first;
  head(Major::array, 1 + count - first);
  head(Major::count, first);
  for (std::size_t k = first; k < count; ++k) {
    if (as_before(k)) {
      simple(cbor::undefined);
    } else {
      write(element, type.part(value, k), k < known ? type.part(other, k) : element.initial);
    }
  }
}

void StateWriter::write_opaque(const Type& type, const void* value, const void* other) {
  if (type.form != nullptr)
    return write(*type.form, type.to_form(value).get(), type.to_form(other).get());
  const void* const object = type.shared(value);
  const auto [at, fresh] = splines_.try_emplace(object, splines_.size());
  if (!fresh) return head(Major::count, at->second);
  with_directions(type, [&]<int D>() { write_spline(*static_cast<const Spline<D>*>(object)); });
}

template <int D>
void StateWriter::write_spline(const Spline<D>& spline) {
  const SplineForm form{form_of<D>(spline.knots()),
                        spline.control_points(),
                        {spline.weights().begin(), spline.weights().end()}};
  write(type_of<SplineForm>(), &form, type_of<SplineForm>().initial);
}

// --- reading
// -----------------------------------------------------------------------------------------------

void StateReader::read(const Type& type, void* value) {
  switch (type.kind) {
    case Kind::boolean:
      return flag(*static_cast<bool*>(value));
    case Kind::integer:
      return integer(*static_cast<int*>(value));
    case Kind::number:
      return number(*static_cast<double*>(value));
    case Kind::text:
      *static_cast<std::string*>(value) = string(Major::text);
      return;
    case Kind::choice: {
      const Choice* const choice = type.choice(name());
      if (choice == nullptr) return static_cast<void>(fail());
      return type.assign(value, choice->value);
    }
    case Kind::optional:
      if (takes(cbor::null)) return type.resize(value, 0);
      if (type.count(value) == 0) type.resize(value, 1);
      return read(*type.element, type.at(value, 0));
    case Kind::list:
    case Kind::array:
      return read_list(type, value);
    case Kind::record:
      return read_record(type, value);
    case Kind::variant: {
      const int k = length(Major::map) == 1 ? type.variant(name()) : -1;
      if (k < 0) return static_cast<void>(fail());
      if (k != type.value(value)) type.assign(value, k);
      return read(held_type(type, value), type.at(value, 0));
    }
    case Kind::opaque:
      return read_opaque(type, value);
  }
}

void StateReader::read_list(const Type& type, void* value) {
  const bool fixed = type.kind == Kind::array;
  if (const std::size_t doubles = doubles_in(*type.element); doubles > 0) {
    const std::string_view numbers = string(Major::bytes);
    const std::size_t all = numbers.size() / (8 * doubles);
    if (8 * doubles * all != numbers.size() || (fixed && all != type.length))
      return static_cast<void>(fail());
    if (!fixed) type.resize(value, all);
    if (all > 0) std::memcpy(type.at(value, 0), numbers.data(), numbers.size());
    return;
  }
  const std::size_t known = type.count(value), items = length(Major::array);
  const std::size_t first = count(known);
  if (bad() || items == 0) return static_cast<void>(fail());
  const std::size_t all = first + items - 1;
  if (fixed && all != type.length) return static_cast<void>(fail());
  for (std::size_t k = first; k < all && !bad(); ++k) {
    if (k < known && takes(cbor::undefined)) continue;
    // Before the list is resized: a length that is a lie must not take the memory first.
    if (k >= known) takes_memory(type.weight);
    if (bad()) return;
    if (k >= known) type.resize(value, k + 1);
    read(*type.element, type.at(value, k));
  }
  if (!fixed && !bad()) type.resize(value, all);
}

void StateReader::read_record(const Type& type, void* value) {
  for (std::size_t n = length(Major::map); n > 0 && !bad(); --n) {
    const Field* const field = type.find(name());
    if (field == nullptr) return static_cast<void>(fail());
    read(*field->type, field->of(value));
  }
  const auto is_missing = [value](const Field& f) {
    return f.type->shared != nullptr && f.type->shared(f.of(value)) == nullptr;
  };
  if (std::ranges::any_of(type.fields, is_missing)) fail();
}

void StateReader::read_opaque(const Type& type, void* value) {
  if (type.form == nullptr) {
    return with_directions(type,
                           [&]<int D>() { read_spline(*static_cast<SplinePointer<D>*>(value)); });
  }
  const std::shared_ptr<void> form = type.to_form(value);
  read(*type.form, form.get());
  if (!bad() && !type.from_form(value, form.get())) fail();
}

template <int D>
void StateReader::read_spline(SplinePointer<D>& spline) {
  if (is(Major::map)) {
    SplineForm form;
    read(type_of<SplineForm>(), &form);
    auto knots = knots_of<D>(std::move(form.knots));
    if (bad() || !knots) return static_cast<void>(fail());
    auto made =
        Spline<D>::create(*std::move(knots), std::move(form.points), std::move(form.weights));
    if (!made) return static_cast<void>(fail());
    spline = std::make_shared<const Spline<D>>(*std::move(made));
    splines_.emplace_back(D, spline);
    return;
  }
  const std::size_t k = count(splines_.size());
  if (bad() || k >= splines_.size() || splines_[k].first != D) return static_cast<void>(fail());
  spline = std::static_pointer_cast<const Spline<D>>(splines_[k].second);
}

}  // namespace knead
