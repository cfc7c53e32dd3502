#include "colours.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "data.hpp"
#include "exchange/part21/part21_text.hpp"
#include "faces.hpp"
#include "surfaces.hpp"

namespace knead::step {
namespace {

using Instance = std::uint32_t;
constexpr int most_nesting = 12;               // of styles, and of shells
constexpr std::size_t most_faces = 5'000'000;  // that items lead to in all

/// DRAUGHTING_PRE_DEFINED_COLOUR (ISO 10303-46).
std::optional<Colour> named_colour(std::string_view name) {
  constexpr std::pair<std::string_view, Colour> known[] = {
      {"red", {1, 0, 0}},     {"green", {0, 1, 0}}, {"blue", {0, 0, 1}},  {"yellow", {1, 1, 0}},
      {"magenta", {1, 0, 1}}, {"cyan", {0, 1, 1}},  {"black", {0, 0, 0}}, {"white", {1, 1, 1}}};
  for (const auto& [known_name, colour] : known) {
    if (known_name == name) return colour;
  }
  return std::nullopt;
}

// STYLED_ITEM → PRESENTATION_STYLE_ASSIGNMENT → … → COLOUR_RGB or a predefined colour (ISO
// 10303-46): the first colour that the styles lead to, passing over those of curves, points and
// lines on surfaces. The item may be a face, a shell or a body; what is styled nearer to the face
// wins, of two at one level the style that overrides, of two equal ones the first.
class Styles {
 public:
  Styles(const Reader& reader, const std::vector<FaceRecord>& faces)
      : reader_(reader), faces_(faces) {}

  std::unordered_map<std::string, Colour> colours() {
    for (const Instance k : reader_.file().named({"STYLED_ITEM", "OVER_RIDING_STYLED_ITEM"}))
      add(k);
    std::unordered_map<std::string, Colour> result;
    for (const auto& [face, found] : found_) result.emplace(name_of(reader_, face), found.second);
    // A surface without a style of its own has the colour of its first face that has one.
    for (const FaceRecord& face : faces_) {
      const auto found = found_.find(face.instance);
      if (found != found_.end() && face.surface != no_instance)
        result.emplace(name_of(reader_, face.surface), found->second.second);
    }
    return result;
  }

 private:
  /// Name, styles, item; of one that overrides, the item overridden.
  void add(Instance styled) {
    const bool over = reader_.is(styled, "OVER_RIDING_STYLED_ITEM");
    const auto attributes = reader_.attributes(
        styled,
        over && !reader_.is(styled, "STYLED_ITEM") ? "OVER_RIDING_STYLED_ITEM" : "STYLED_ITEM", 1,
        2);
    if (attributes.empty() || !reader_.is_list(attributes[0])) return;
    const auto item = reader_.reference(attributes[1]);
    std::optional<Colour> colour;
    for (const Instance style : reader_.references(attributes[0])) {
      if (!colour) colour = colour_below(style, 0);
    }
    if (item && colour) paint(*item, *colour, 2 * rank_of(*item) + (over ? 1 : 0), 0);
  }

  /// References in a record, lists included.
  std::vector<Instance> below(Instance instance) const {
    std::vector<Instance> result;
    const Part21Instance& record = reader_.file().instance(instance);
    for (std::uint32_t k = record.first; k < record.last; ++k) {
      if (const auto target = reader_.reference(k)) result.push_back(*target);
    }
    return result;
  }

  std::optional<Colour> colour_below(Instance style, int depth) const {
    if (depth > most_nesting) return std::nullopt;
    for (const char* other : {"CURVE_STYLE", "POINT_STYLE", "SURFACE_STYLE_BOUNDARY",
                              "SURFACE_STYLE_PARAMETER_LINE", "SURFACE_STYLE_CONTROL_GRID",
                              "SURFACE_STYLE_SEGMENTATION_CURVE", "SURFACE_STYLE_SILHOUETTE"}) {
      if (reader_.is(style, other)) return std::nullopt;
    }
    if (const auto attributes = reader_.attributes(style, "COLOUR_RGB", 1, 3);
        reader_.is(style, "COLOUR_RGB") && !attributes.empty()) {
      Colour colour{};
      for (std::size_t c = 0; c < 3; ++c)
        colour[c] = std::clamp(reader_.real(attributes[c]).value_or(0), 0.0, 1.0);
      return colour;
    }
    for (const char* kind : {"DRAUGHTING_PRE_DEFINED_COLOUR", "PRE_DEFINED_COLOUR"}) {
      const auto attributes = reader_.attributes(style, kind, 0, 1);
      if (reader_.is(style, kind) && !attributes.empty())
        return named_colour(reader_.string(attributes[0]));
    }
    for (const Instance next : below(style)) {
      if (const auto colour = colour_below(next, depth + 1)) return colour;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool is_face(Instance k) const {
    return reader_.is(k, "ADVANCED_FACE") || reader_.is(k, "FACE_SURFACE") ||
           reader_.is(k, "FACE") || is_bounded_surface(reader_, k);
  }
  [[nodiscard]] bool is_shell(Instance k) const {
    return reader_.is(k, "CLOSED_SHELL") || reader_.is(k, "OPEN_SHELL") ||
           reader_.is(k, "CONNECTED_FACE_SET") || reader_.is(k, "ORIENTED_CLOSED_SHELL") ||
           reader_.is(k, "ORIENTED_OPEN_SHELL");
  }
  [[nodiscard]] bool is_body(Instance k) const {
    return reader_.is(k, "MANIFOLD_SOLID_BREP") || reader_.is(k, "BREP_WITH_VOIDS") ||
           reader_.is(k, "FACETED_BREP") || reader_.is(k, "SHELL_BASED_SURFACE_MODEL") ||
           reader_.is(k, "FACE_BASED_SURFACE_MODEL") || reader_.is(k, "GEOMETRIC_SET") ||
           reader_.is(k, "ADVANCED_BREP_SHAPE_REPRESENTATION") ||
           reader_.is(k, "MANIFOLD_SURFACE_SHAPE_REPRESENTATION") ||
           reader_.is(k, "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION");
  }
  /// What is closer to a face comes first.
  [[nodiscard]] int rank_of(Instance k) const { return is_body(k) ? 0 : is_shell(k) ? 1 : 2; }

  void paint(Instance item, const Colour& colour, int rank, int depth) {
    if (depth > most_nesting || ++painted_ > most_faces) return;
    if (is_shell(item) || is_body(item)) {
      for (const Instance next : below(item)) paint(next, colour, rank, depth + 1);
      return;
    }
    if (!is_face(item) && !reader_.is(item, "BOUNDED_SURFACE") &&
        !reader_.is(item, "B_SPLINE_SURFACE_WITH_KNOTS") && !reader_.is(item, "BEZIER_SURFACE") &&
        !reader_.is(item, "UNIFORM_SURFACE") && !reader_.is(item, "QUASI_UNIFORM_SURFACE")) {
      return;
    }
    const auto [found, fresh] = found_.try_emplace(item, rank, colour);
    if (!fresh && found->second.first < rank) found->second = {rank, colour};
  }

  const Reader& reader_;
  const std::vector<FaceRecord>& faces_;
  std::map<Instance, std::pair<int, Colour>> found_;
  std::size_t painted_ = 0;
};

}  // namespace

std::unordered_map<std::string, Colour> face_colours(const File& file) {
  const Reader reader(file.data().records);
  return Styles(reader, file.data().of.faces).colours();
}

}  // namespace knead::step
