#pragma once

#include "type.hpp"

namespace knead {

namespace detail {

template <class T>
concept Described = requires(T& value, Fields& fields) {
  describe(value, fields);
};
template <class T>
concept Chosen = std::is_enum_v<T> && requires(T value) {
  choices(value);
};
template <class T>
concept SmallVector = requires(T& value) {
  { value.data() } -> std::same_as<typename T::Scalar*>;
  requires(T::SizeAtCompileTime > 0);
};

template <class T>
T& as(void* value) {
  return *static_cast<T*>(value);
}
template <class T>
const T& as(const void* value) {
  return *static_cast<const T*>(value);
}

template <class T>
const void* initial_value() {
  static const T value = initial_of<T>();
  return &value;
}

template <class T>
struct TypeMaker;

template <class E, std::size_t N>
Type array_type() {
  return {.kind = Kind::array,
          .element = &type_of<E>(),
          .length = N,
          .count = [](const void*) { return N; },
          .at = [](void* v, std::size_t k) -> void* { return static_cast<E*>(v) + k; }};
}
template <class E, std::size_t N>
struct TypeMaker<std::array<E, N>> {
  static Type make() { return array_type<E, N>(); }
};
template <class T>
requires SmallVector<T>
struct TypeMaker<T> {
  static Type make() {
    return array_type<typename T::Scalar, static_cast<std::size_t>(T::SizeAtCompileTime)>();
  }
};
template <class E>
struct TypeMaker<std::vector<E>> {
  static_assert(!std::is_same_v<E, bool>);
  static Type make() {
    return {
        .kind = Kind::list,
        .element = &type_of<E>(),
        .count = [](const void* v) { return as<std::vector<E>>(v).size(); },
        .resize = [](void* v, std::size_t n) { as<std::vector<E>>(v).resize(n, initial_of<E>()); },
        .at = [](void* v, std::size_t k) -> void* { return &as<std::vector<E>>(v)[k]; },
        .weight = sizeof(E)};
  }
};
template <class E>
struct TypeMaker<std::optional<E>> {
  static Type make() {
    return {
        .kind = Kind::optional,
        .element = &type_of<E>(),
        .count =
            [](const void* v) { return as<std::optional<E>>(v).has_value() ? std::size_t(1) : 0; },
        .resize =
            [](void* v, std::size_t n) {
              auto& optional = as<std::optional<E>>(v);
              if (n == 0) {
                optional.reset();
              } else {
                optional.emplace();
              }
            },
        .at = [](void* v, std::size_t) -> void* { return &*as<std::optional<E>>(v); }};
  }
};
template <class E>
requires Chosen<E>
struct TypeMaker<E> {
  static Type make() {
    return {.kind = Kind::choice,
            .choices = choices(E{}),
            .value = [](const void* v) { return static_cast<int>(as<E>(v)); },
            .assign = [](void* v, int k) { as<E>(v) = static_cast<E>(k); }};
  }
};
template <class T>
requires Described<T>
struct TypeMaker<T> {
  static Type make() {
    Type type;
    T value = initial_of<T>();
    Fields fields(type, &value);
    describe(value, fields);
    return type;
  }
};
template <class... T>
struct TypeMaker<std::variant<T...>> {
  using Variant = std::variant<T...>;
  static Type make() {
    using Make = void (*)(Variant&);
    static constexpr Make makers[] = {[](Variant& v) { v.template emplace<T>(); }...};
    return {.kind = Kind::variant,
            .name = tag_of(static_cast<const Variant*>(nullptr)),
            .variants = {&type_of<T>()...},
            .at = [](void* v, std::size_t) -> void* {
              return std::visit([](auto& held) -> void* { return &held; }, as<Variant>(v));
            },
            .value = [](const void* v) { return static_cast<int>(as<Variant>(v).index()); },
            .assign = [](void* v, int k) { makers[k](as<Variant>(v)); }};
  }
};
template <class T>
requires is_opaque<T>
struct TypeMaker<T> {
  static Type make() {
    return {.kind = Kind::opaque,
            .shared = [](const void* v) -> const void* { return as<T>(v).get(); }};
  }
};
template <>
struct TypeMaker<bool> {
  static Type make() { return {.kind = Kind::boolean}; }
};
template <>
struct TypeMaker<int> {
  static Type make() { return {.kind = Kind::integer}; }
};
template <>
struct TypeMaker<double> {
  static Type make() { return {.kind = Kind::number}; }
};
template <>
struct TypeMaker<std::string> {
  static Type make() { return {.kind = Kind::text}; }
};

}  // namespace detail

/// Makes the table of T where `type_of<T>` is a specialisation that one file defines.
template <class T>
const Type& make_type() {
  static const Type type = [] {
    Type made = detail::TypeMaker<T>::make();
    made.initial = detail::initial_value<T>();
    return made;
  }();
  return type;
}

template <class T>
const Type& type_of() {
  return make_type<T>();
}

}  // namespace knead
