#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "describe/bytes.hpp"
#include "knead/session/command.hpp"

namespace knead::studio {

// Fields of requests and answers that are no JSON of their own; their descriptions name the page's
// type. Numbers, bytes and long texts lie in the module's memory beside the JSON, which says where.

using knead::Bytes;
struct Text {
  std::string data;
};
struct Doubles {
  std::vector<double> data;
};
struct Nothing {};

using Commands = std::vector<Command>;
/// Of a display, by their names.
using Settings = std::vector<std::pair<std::string, std::vector<double>>>;

}  // namespace knead::studio

namespace knead::detail {

template <>
struct TypeMaker<std::vector<float>> {
  static Type make() { return memory_type<std::vector<float>>("Float32Array"); }
};
template <>
struct TypeMaker<std::vector<std::uint32_t>> {
  static Type make() { return memory_type<std::vector<std::uint32_t>>("Uint32Array"); }
};
template <>
struct TypeMaker<std::vector<std::uint8_t>> {
  static Type make() { return memory_type<std::vector<std::uint8_t>>("Uint8Array"); }
};
template <>
struct TypeMaker<studio::Doubles> {
  static Type make() { return memory_type<studio::Doubles>("Float64Array"); }
};
template <>
struct TypeMaker<studio::Text> {
  static Type make() { return memory_type<studio::Text>("string"); }
};
template <>
struct TypeMaker<studio::Nothing> {
  static Type make() { return own_type("null"); }
};
template <>
struct TypeMaker<studio::Commands> {
  static Type make() { return own_type("AnyCommand[]"); }
};
template <>
struct TypeMaker<studio::Settings> {
  static Type make() { return own_type("Record<string, number | number[]>"); }
};

}  // namespace knead::detail
