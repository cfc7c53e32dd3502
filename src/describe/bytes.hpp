#pragma once

#include <string>

#include "describe.hpp"

namespace knead {

/// The content of a file, as a field of a request or an answer. It is no JSON of its own: it lies
/// beside the JSON, which says how many bytes it has.
struct Bytes {
  std::string data;
};

namespace detail {

/// Of a value that is read and written by itself, `page_type` in TypeScript.
inline Type own_type(std::string_view page_type) {
  return {.kind = Kind::opaque, .name = page_type};
}

/// Of elements one after the other in memory.
template <class T>
Type memory_type(std::string_view page_type) {
  static constexpr auto data = [](T & value) -> auto& {
    if constexpr (requires { value.data.data(); }) {
      return value.data;
    } else {
      return value;
    }
  };
  Type type = own_type(page_type);
  type.count = [](const void* v) {
    return data(*static_cast<T*>(const_cast<void*>(v))).size();
  };  // NOLINT: as `part`
  type.at = [](void* v, std::size_t k) -> void* { return data(*static_cast<T*>(v)).data() + k; };
  return type;
}

template <>
struct TypeMaker<Bytes> {
  static Type make() { return memory_type<Bytes>("Uint8Array"); }
};

}  // namespace detail
}  // namespace knead
