#include "space_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "describe/describe.hpp"
#include "describe/record_json.hpp"
#include "energy/formula.hpp"
#include "sculpt/lattice.hpp"

namespace knead {
namespace fields {
namespace {

struct LatticeMove {
  std::vector<int> which;
  std::array<double, 3> by = {};
};

struct LatticeMap {
  std::array<int, 3> net = {6, 6, 6}, degree = {3, 3, 3};
  double margin = 0.05;
  std::optional<std::array<double, 3>> lower, upper;
  std::vector<LatticeMove> moves;
};

void describe(LatticeMove& m, Fields& fields) {
  fields.name("lattice move", "How far control points of a block are moved.");
  fields.add("which", m.which,
             {.help = "that of indices i, j, k along x, y, z is `(i * net[1] + j) * net[2] + k`",
              .presence = Presence::required});
  fields.add("by", m.by, {.unit = Unit::length, .presence = Presence::required});
}

void describe(LatticeMap& m, Fields& fields) {
  fields.name("lattice map", "A block of space of which control points are moved.");
  fields.add("net", m.net, {.help = "control points of the block along x, y, z"});
  fields.add("degree", m.degree, {.help = "along x, y, z"});
  fields.add("margin", m.margin,
             {.help = "how far the block reaches beyond the model, as a share of the diagonal",
              .unit = Unit::fraction,
              .range = above(0)});
  fields.add("lower", m.lower, {.help = "where the block begins", .unit = Unit::length});
  fields.add("upper", m.upper, {.help = "where it ends", .unit = Unit::length});
  fields.add("moves", m.moves, {.presence = Presence::required});
}

Expected<SpaceMap> formulas_of(std::string_view text) {
  static constexpr std::array<std::string_view, 3> variables = {"x", "y", "z"};
  std::vector<Formula> formulas;
  std::size_t begin = 0;
  for (;;) {
    const auto end = std::min(text.find(';', begin), text.size());
    const auto formula = Formula::parse(text.substr(begin, end - begin), variables);
    if (!formula)
      return std::unexpected(
          formula.error().within(fmt::format("formula {}", formulas.size() + 1)));
    formulas.push_back(*formula);
    if (end == text.size() || formulas.size() > 3) break;
    begin = end + 1;
  }
  if (formulas.size() != 3)
    return input_error(formulas.size() > 3
                           ? "there are more than three formulas"
                           : fmt::format("there are {} formulas, not three", formulas.size()),
                       {}, "write the displacement along x, y and z, separated by semicolons");
  return SpaceMap([formulas = std::move(formulas)](const Point& place) -> Expected<Point> {
    Point result;
    for (Eigen::Index k = 0; k < 3; ++k)
      result[k] = formulas[static_cast<std::size_t>(k)](std::span(place.data(), 3));
    return result;
  });
}

Expected<SpaceMap> lattice_of(std::string_view text, const BoundingBox& model) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  LatticeMap map;
  if (auto read = read_record(*json, type_of<LatticeMap>(), &map); !read)
    return std::unexpected(read.error());
  if (map.lower.has_value() != map.upper.has_value())
    return input_error("one corner of the block is missing", map.lower ? "upper" : "lower",
                       "give both, or neither");
  auto lattice = map.lower ? Lattice::between(Point(map.lower->data()), Point(map.upper->data()),
                                              map.degree, map.net)
                           : Lattice::create(model, map.margin, map.degree, map.net);
  if (!lattice) return std::unexpected(lattice.error());
  Points points = lattice->rest().control_points();
  for (std::size_t k = 0; k < map.moves.size(); ++k) {
    auto moved = lattice->moved(std::move(points), map.moves[k].which, map.moves[k].by);
    if (!moved) return std::unexpected(moved.error().within(fmt::format("moves[{}]", k)));
    points = *std::move(moved);
  }
  auto displacement = lattice->displacement(points);
  if (!displacement) return std::unexpected(displacement.error());
  return SpaceMap(*std::move(displacement));
}

}  // namespace

Expected<SpaceMap> SpaceMap::parse(std::string_view text, const BoundingBox& model) {
  constexpr std::string_view block = "lattice:";
  if (!text.starts_with(block)) return formulas_of(text);
  auto lattice = lattice_of(text.substr(block.size()), model);
  if (!lattice) return std::unexpected(lattice.error().within("lattice"));
  return lattice;
}

Expected<Point> SpaceMap::at(const Point& place) const {
  auto result = displacement_(place);
  if (result && !result->allFinite())
    return input_error("the displacement is not finite",
                       fmt::format("at ({:.6g}, {:.6g}, {:.6g})", place[0], place[1], place[2]),
                       "use formulas that have a value at every point of the model");
  return result;
}

}  // namespace fields

}  // namespace knead
