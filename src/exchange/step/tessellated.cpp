#include "tessellated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "faces.hpp"

namespace knead::step {
namespace {

using Index = std::uint32_t;
constexpr double most_copied = 5e6;  // triangles of all items, beyond their first places

/// The parts of an item's record: its coordinates, normals, indices of points, and lists of
/// triangles.
struct ItemLayout {
  Index coordinates = no_instance;
  Index normals = 0, pnindex = 0;                // values
  std::optional<Index> triangles, strips, fans;  // values
};

/// Attributes of the four kinds; in a simple record those of the supertypes come first.
/// ISO 10303-42, tessellated shapes: `pnindex`, if not empty, lists the coordinates that the item
/// uses, and triangles, strips and fans count in that list. All indices begin at 1.
std::optional<ItemLayout> layout_of(const Reader& reader, Index item) {
  const auto read = [&](std::string_view kind, std::string_view super, std::size_t inherited,
                        bool complex) -> std::optional<ItemLayout> {
    const auto above = reader.attributes(item, super, 1, 3);
    const auto attributes = reader.attributes(item, kind, inherited, complex ? 3 : 2);
    const auto list = above.empty() ? std::nullopt : reader.reference(above[0]);
    if (attributes.empty() || !list) return std::nullopt;
    ItemLayout layout{*list, above[2], attributes[0], {}, {}, {}};
    if (complex) {
      layout.strips = attributes[1];
      layout.fans = attributes[2];
    } else {
      layout.triangles = attributes[1];
    }
    return layout;
  };
  if (reader.is(item, "TRIANGULATED_FACE"))
    return read("TRIANGULATED_FACE", "TESSELLATED_FACE", 5, false);
  if (reader.is(item, "COMPLEX_TRIANGULATED_FACE"))
    return read("COMPLEX_TRIANGULATED_FACE", "TESSELLATED_FACE", 5, true);
  if (reader.is(item, "TRIANGULATED_SURFACE_SET"))
    return read("TRIANGULATED_SURFACE_SET", "TESSELLATED_SURFACE_SET", 4, false);
  return read("COMPLEX_TRIANGULATED_SURFACE_SET", "TESSELLATED_SURFACE_SET", 4, true);
}

/// Turns what indices and lists say into triangles of one item.
class MeshBuilder {
 public:
  MeshBuilder(const Reader& reader, Index item, const ItemLayout& layout,
              const std::vector<Point>& coordinates)
      : reader_(reader), item_(item), layout_(layout), coordinates_(coordinates) {}

  Expected<FaceMesh> build() {
    if (auto status = read_indices(); !status) return std::unexpected(status.error());
    if (auto status = read_normals(); !status) return std::unexpected(status.error());
    if (auto status = read_triangles(); !status) return std::unexpected(status.error());
    if (triangles_.empty()) return reader_.error(item_, "it has no triangles");
    FaceMesh mesh{name_of(reader_, item_), {}, {}, {}, {}};
    mesh.tessellated = true;
    if (normals_.empty())
      // Without normals facets are all that is known.
      make_flat(mesh);
    else
      make_smooth(mesh);
    return mesh;
  }

 private:
  [[nodiscard]] std::vector<Index> list(Index value) const {
    return reader_.is_list(value) ? reader_.file().children(value) : std::vector<Index>();
  }
  /// How many points indices choose from.
  [[nodiscard]] std::size_t count() const {
    return pnindex_.empty() ? coordinates_.size() : pnindex_.size();
  }
  [[nodiscard]] const Point& point(Index k) const {
    return coordinates_[pnindex_.empty() ? k : pnindex_[k]];
  }

  Expected<Index> index(Index value, std::size_t most, std::string_view of) const {
    const auto read = reader_.integer(value);
    if (!read || *read < 1 || static_cast<std::size_t>(*read) > most) {
      return reader_.error(item_,
                           fmt::format("an index is {}, which is none of its {} {}",
                                       read ? std::to_string(*read) : "no whole number", most, of),
                           "get the file as it was written");
    }
    return static_cast<Index>(*read - 1);
  }

  Expected<void> read_indices() {
    for (const Index value : list(layout_.pnindex)) {
      const auto k = index(value, coordinates_.size(), "coordinates");
      if (!k) return std::unexpected(k.error());
      pnindex_.push_back(*k);
    }
    return {};
  }

  Expected<void> read_normals() {
    for (const Index row : list(layout_.normals)) {
      const auto parts = list(row);
      Point normal = Point::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto read = parts.size() == 3 ? reader_.length(parts[k]) : std::nullopt;
        if (!read)
          return reader_.error(item_,
                               fmt::format("normal {} is not three numbers", normals_.size() + 1));
        normal[static_cast<Eigen::Index>(k)] = *read;
      }
      normals_.push_back(normal.stableNormalized());
    }
    // Without indices of their own, normals go with the first coordinates.
    const bool fits =
        normals_.size() < 2 || (pnindex_.empty() ? normals_.size() <= coordinates_.size()
                                                 : normals_.size() == pnindex_.size());
    if (fits) return {};
    return reader_.error(item_,
                         fmt::format("it has {} normals for {} points", normals_.size(), count()),
                         "give it none, one, or one per point");
  }

  Expected<void> read_triangles() {
    if (layout_.triangles) {
      for (const Index row : list(*layout_.triangles)) {
        const auto corners = indices(row, "triangle");
        if (!corners) return std::unexpected(corners.error());
        if (corners->size() != 3)
          return reader_.error(item_, fmt::format("a triangle has {} corners", corners->size()));
        add((*corners)[0], (*corners)[1], (*corners)[2]);
      }
    }
    if (layout_.strips) {
      for (const Index row : list(*layout_.strips)) {
        const auto strip = indices(row, "strip");
        if (!strip) return std::unexpected(strip.error());
        for (std::size_t k = 2; k < strip->size(); ++k) {
          // A strip of k points has k − 2 triangles; every other one lists its corners the other
          // way round.
          const bool turned = k % 2 != 0;
          add((*strip)[turned ? k - 1 : k - 2], (*strip)[turned ? k - 2 : k - 1], (*strip)[k]);
        }
      }
    }
    if (layout_.fans) {
      for (const Index row : list(*layout_.fans)) {
        const auto fan = indices(row, "fan");
        if (!fan) return std::unexpected(fan.error());
        for (std::size_t k = 2; k < fan->size(); ++k) add((*fan)[0], (*fan)[k - 1], (*fan)[k]);
      }
    }
    return {};
  }

  Expected<std::vector<Index>> indices(Index row, std::string_view what) const {
    std::vector<Index> result;
    const std::size_t most = normals_.size() < 2 ? count() : normals_.size();
    for (const Index value : list(row)) {
      const auto k = index(value, most, "points");
      if (!k) return std::unexpected(k.error());
      result.push_back(*k);
    }
    if (result.size() >= 3) return result;
    return reader_.error(item_, fmt::format("a {} has fewer than three points", what));
  }

  void add(Index a, Index b, Index c) {
    if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
  }

  [[nodiscard]] Point across(const std::array<Index, 3>& t) const {
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }

  /// Points and normals of their own for every triangle.
  void make_flat(FaceMesh& mesh) const {
    for (const auto& t : triangles_) {
      const auto first = static_cast<Index>(mesh.points.size());
      const Point normal = across(t).stableNormalized();
      for (const Index k : t) {
        mesh.points.push_back(point(k));
        mesh.normals.push_back(normal);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }

  /// The points that triangles use, with the normals of the file.
  void make_smooth(FaceMesh& mesh) const {
    const auto normal = [&](Index k) { return normals_[normals_.size() == 1 ? 0 : k]; };
    std::vector<Index> places(count(), no_instance);
    double seen = 0;  // area from the tips of the normals, less that from behind
    for (const auto& t : triangles_) {
      seen += across(t).dot(normal(t[0]) + normal(t[1]) + normal(t[2]));
      std::array<Index, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        Index& place = places[t[k]];
        if (place == no_instance) {
          place = static_cast<Index>(mesh.points.size());
          mesh.points.push_back(point(t[k]));
          mesh.normals.push_back(normal(t[k]));
        }
        corners[k] = place;
      }
      mesh.triangles.push_back(corners);
    }
    // Some writers list corners clockwise; the normals of the file are the better witness.
    if (seen >= 0) return;
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }

  const Reader& reader_;
  Index item_;
  const ItemLayout& layout_;
  const std::vector<Point>& coordinates_;
  std::vector<Index> pnindex_;
  std::vector<Point> normals_;
  std::vector<std::array<Index, 3>> triangles_;
};

/// The item in all its places.
FaceMesh placed(FaceMesh mesh, const std::vector<Eigen::Affine3d>& places) {
  FaceMesh result{mesh.id, {}, {}, {}, {}};
  result.tessellated = true;
  if (places.size() == 1 && places[0].matrix().isIdentity(0)) return mesh;
  for (const Eigen::Affine3d& place : places) {
    const auto first = static_cast<Index>(result.points.size());
    for (const Point& p : mesh.points) result.points.push_back(place * p);
    for (const Point& n : mesh.normals) result.normals.push_back(place.linear() * n);
    for (const auto& t : mesh.triangles)
      result.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return result;
}

}  // namespace

Expected<const std::vector<Point>*> TessellatedReader::coordinates(std::uint32_t list) {
  const auto [found, fresh] = lists_.try_emplace(list);
  if (!fresh) {
    if (found->second.empty()) return reader_.error(list, "it has no coordinates that can be read");
    return &found->second;
  }
  const auto attributes = reader_.attributes(list, "COORDINATES_LIST", 1, 2);
  std::vector<Point> points;
  if (reader_.is(list, "COORDINATES_LIST") && !attributes.empty() &&
      reader_.is_list(attributes[1])) {
    for (const Index row : reader_.file().children(attributes[1])) {
      const auto parts = reader_.is_list(row) ? reader_.file().children(row) : std::vector<Index>();
      Point p;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto read = parts.size() == 3 ? reader_.length(parts[k]) : std::nullopt;
        if (!read) {
          return reader_.error(list, fmt::format("point {} is not three numbers of at most {}",
                                                 points.size() + 1, largest_number));
        }
        p[static_cast<Eigen::Index>(k)] = *read;
      }
      points.push_back(p);
    }
  }
  if (points.empty()) return reader_.error(list, "it has no coordinates");
  found->second = std::move(points);
  return &found->second;
}

Expected<FaceMesh> TessellatedReader::mesh(const TessellatedRecord& record) {
  const auto layout = layout_of(reader_, record.instance);
  if (!layout)
    return reader_.error(record.instance, "its record is incomplete",
                         "check that the file is complete");
  const auto points = coordinates(layout->coordinates);
  if (!points) return std::unexpected(points.error());
  auto mesh = MeshBuilder(reader_, record.instance, *layout, **points).build();
  if (!mesh) return mesh;
  const double copies =
      static_cast<double>(mesh->triangles.size()) * (static_cast<double>(record.places.size()) - 1);
  if (copied_ + copies > most_copied)
    return reader_.error(record.instance,
                         fmt::format("sets put it in {} places", record.places.size()));
  copied_ += copies;
  return placed(*std::move(mesh), record.places);
}

}  // namespace knead::step
