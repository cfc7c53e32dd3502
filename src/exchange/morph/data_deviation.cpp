#include "data_deviation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "knead/spline/evaluate.hpp"
#include "morph_deviation.hpp"
#include "morph_points.hpp"
#include "morph_report.hpp"

namespace knead {

void describe(DataDeviation& d, Fields& fields) {
  fields.name("data deviation",
              "How far data are from the faces of a document. Of each point there are numbers of "
              "8 bytes (Float64, little-endian), in the order of the data.");
  fields.add("unit", d.unit, {.help = "of lengths, as the file names it"});
  fields.add("size", d.size, {.help = "diagonal of the model's box", .unit = Unit::length});
  fields.add("reach", d.reach, {.help = "farthest from a face", .unit = Unit::length});
  fields.add("points", d.points, {.help = "of the data"});
  fields.add("used", d.used, {.help = "of them"});
  fields.add("left_out", d.left_out, {.help = "farther from every face than the reach"});
  fields.add("beyond_border", d.beyond_border, {.help = "of a scan: points beside the model"});
  fields.add("turned_away", d.turned_away,
             {.help = "of a scan: points whose normals are more than 45 degrees from those of the "
                      "model"});
  fields.add("deviation", d.deviation, {.help = "sizes of the distances of points that are used"});
  fields.add("alignment", d.alignment, {.help = "null: not asked for"});
  fields.add("places", d.places, {.help = "x, y, z of the points, of a scan once it is aligned"});
  fields.add("feet", d.feet, {.help = "x, y, z of their partners on the faces, 0 without one"});
  fields.add("normals", d.normals, {.help = "x, y, z of the outward normals of the faces there"});
  fields.add(
      "wanted", d.wanted,
      {.help = "x, y, z of the displacements wanted there, unscaled; of a scan to the point"});
  fields.add("distances", d.distances,
             {.help = "their parts along these normals: above 0 outside"});
  fields.add("states", d.states,
             {.help = "a byte of each point: 0 used, 1 farther than the reach, 2 beside the model, "
                      "3 facing another way"});
}

namespace detail {
namespace {

static_assert(std::endian::native == std::endian::little);

void put(Bytes& to, std::size_t number, const Point& point) {
  std::memcpy(to.data.data() + 24 * number, point.data(), 24);
}

/// The points of the data in the model. Of a map of space there are none: they are the feet.
std::span<const Point> places_of(const MorphPoints& points) {
  return points.scan ? std::span(points.scan->points) : std::span(points.places);
}

/// Of the points with a partner.
Expected<void> add_partners(const MovingModel& model, const MorphPoints& points,
                            DataDeviation& result) {
  const auto senses = outward_senses(model);
  std::vector<Difference> differences;
  for (std::size_t k = 0; k < points.found.data.size(); ++k) {
    const morph::Datum& datum = points.found.data[k];
    const std::size_t number = points.found.numbers[k];
    const Surface& surface = *model.placed[static_cast<std::size_t>(datum.surface)].surface;
    const auto foot = evaluate_point<2>(surface, datum.parameters);
    if (!foot) return std::unexpected(foot.error());
    Point normal = datum.along;
    if (normal.isZero(0)) {
      const auto there = morph::normal_at(surface, datum.parameters);
      if (!there) return std::unexpected(there.error());
      normal = *there;
    }
    normal *= senses[static_cast<std::size_t>(datum.surface)];
    const double distance = datum.displacement.dot(normal);
    put(result.feet, number, *foot);
    put(result.normals, number, normal);
    put(result.wanted, number, datum.displacement);
    std::memcpy(result.distances.data.data() + 8 * number, &distance, 8);
    result.states.data[number] = static_cast<char>(morph::PointState::used);
    differences.push_back({std::abs(distance), distance});
  }
  result.deviation = deviation_of(differences);
  return {};
}

}  // namespace

Expected<DataDeviation> data_deviation(const std::shared_ptr<const Source>& source,
                                       const MorphData& data, MorphSettings settings) {
  settings.scale = data.scan ? 0 : 1;  // partners of a scan are sought without a fit
  if (auto right = check_settings(settings); !right) return std::unexpected(right.error());
  const auto model = moving_model(source, settings);
  if (!model) return std::unexpected(model.error());
  const auto points = points_of(*model, data, settings);
  if (!points) return std::unexpected(points.error());
  DataDeviation result{.unit = model->unit(), .size = points->size, .reach = points->reach};
  result.points = static_cast<int>(points->count);
  result.used = static_cast<int>(points->found.data.size());
  result.left_out = static_cast<int>(points->found.left_out);
  if (points->alignment) result.alignment = as_reported(*points->alignment);
  for (Bytes* each : {&result.places, &result.feet, &result.normals, &result.wanted})
    each->data.resize(24 * points->count);
  result.distances.data.resize(8 * points->count);
  result.states.data.assign(points->count, static_cast<char>(morph::PointState::far));
  if (points->first) {
    result.beyond_border = static_cast<int>(points->first->beyond_border);
    result.turned_away = static_cast<int>(points->first->turned_away);
    std::ranges::transform(points->first->states, result.states.data.begin(),
                           [](morph::PointState state) { return static_cast<char>(state); });
  }
  if (auto added = add_partners(*model, *points, result); !added)
    return std::unexpected(added.error());
  const auto places = places_of(*points);
  for (std::size_t k = 0; k < places.size(); ++k) put(result.places, k, places[k]);
  if (places.empty()) result.places = result.feet;
  return result;
}

}  // namespace detail
}  // namespace knead
