#include "bounded_faces.hpp"

#include <algorithm>
#include <numbers>
#include <unordered_map>

#include "brep/rectangle_sides.hpp"
#include "exchange/step/item_kinds.hpp"

namespace knead::step {
namespace {

/// The representation in which each item stands, alone or in a set.
std::unordered_map<std::uint32_t, std::uint32_t> representations(const Reader& reader) {
  std::unordered_map<std::uint32_t, std::uint32_t> result;
  for (const std::string_view kind : reader.file().keywords()) {
    if (!holds_shape(kind)) continue;
    for (const auto k : reader.file().named({kind})) {
      const auto attributes = reader.attributes(k, "REPRESENTATION", 0, 2);
      for (const auto item :
           attributes.empty() ? std::vector<std::uint32_t>() : reader.references(attributes[1])) {
        result.try_emplace(item, k);
        const auto set = reader.is(item, "GEOMETRIC_SET")
                             ? reader.attributes(item, "GEOMETRIC_SET", 1, 1)
                             : std::vector<std::uint32_t>();
        for (const auto element :
             set.empty() ? std::vector<std::uint32_t>() : reader.references(set[0]))
          result.try_emplace(element, k);
      }
    }
  }
  return result;
}

class SurfaceBounds {
 public:
  SurfaceBounds(const Reader& reader, brep::Model& model)
      : reader_(reader),
        model_(model),
        pieces_(reader, model),
        held_(representations(reader)),
        next_(reader.file().largest_id()),
        edges_(model, [this] { return "#" + std::to_string(++next_); }) {}

  void add(const FaceRecord& record, brep::Face& face) {
    const auto held = held_.find(record.instance);
    group_ = held == held_.end() ? brep::BoundaryEdges::Group() : held->second;
    const brep::Support& support = model_.supports[face.support];
    if (reader_.is(record.instance, "RECTANGULAR_TRIMMED_SURFACE"))
      add_rectangle(record, support, face);
    else
      add_boundaries(record, support, face);
  }

  BoundarySources sources() { return std::move(sources_); }

 private:
  /// Basis surface, u1, u2, v1, v2, whether u and v run as they do on it. Between two parameters of
  /// a closed direction there are two ways: u goes up from u1 to u2 where it runs as on the basis
  /// surface, else down.
  void add_rectangle(const FaceRecord& record, const brep::Support& support, brep::Face& face) {
    const auto attributes =
        reader_.attributes(record.instance, "RECTANGULAR_TRIMMED_SURFACE", 1, 7);
    const auto scale = attributes.empty() ? Expected<std::array<double, 2>>(reader_.error(
                                                record.instance, "its limits are not complete"))
                                          : parameter_scale(reader_, record.surface, support);
    if (!scale) return unknown(face, scale.error());
    std::array<Interval, 2> range;
    std::array<bool, 2> along = {true, true};
    for (std::size_t d = 0; d < 2; ++d) {
      const auto first = reader_.length(attributes[2 * d + 1]),
                 last = reader_.length(attributes[2 * d + 2]);
      if (!first || !last)
        return unknown(face, reader_.error(record.instance, "its limits are no numbers").error());
      along[d] = reader_.enumeration(attributes[5 + d]) != "F";
      range[d] = {(*scale)[d] * *first, (*scale)[d] * *last};
      if (!along[d] && range[d].lower > range[d].upper) std::swap(range[d].lower, range[d].upper);
      if (range[d].lower >= range[d].upper) range[d].upper += period(support, d);
    }
    face.same_sense = along[0] == along[1];
    add_sides(support, range, face);
  }

  void add_sides(const brep::Support& support, const std::array<Interval, 2>& range,
                 brep::Face& face) {
    auto sides = brep::rectangle_sides(model_, support, range[0], range[1]);
    if (!sides) return unknown(face, sides.error());
    std::vector<SurfacePiece> pieces;
    for (brep::BoundaryPiece& side : *sides)
      static_cast<brep::BoundaryPiece&>(pieces.emplace_back()) = std::move(side);
    add_bound(pieces, support, face);
  }

  /// Of a direction of a surface that closes by its form; else 0.
  [[nodiscard]] static double period(const brep::Support& support, std::size_t d) {
    constexpr double turn = 2 * std::numbers::pi;
    using Kind = brep::ElementarySurface::Kind;
    if (const auto* form = std::get_if<brep::ElementarySurface>(&support.form))
      return (d == 0 ? form->kind != Kind::plane : form->kind == Kind::torus) ? turn : 0;
    const auto* swept = std::get_if<brep::SweptSurface>(&support.form);
    return swept != nullptr && swept->revolution && d == 0 ? turn : 0;
  }

  /// Basis surface, boundaries, whether its own is one of them.
  void add_boundaries(const FaceRecord& record, const brep::Support& support, brep::Face& face) {
    const auto attributes = reader_.attributes(record.instance, "CURVE_BOUNDED_SURFACE", 1, 3);
    if (attributes.empty() || !reader_.is_list(attributes[1]))
      return unknown(face, reader_.error(record.instance, "it has no list of boundaries").error());
    const auto boundaries = reader_.references(attributes[1]);
    const bool implicit = reader_.enumeration(attributes[2]) == "T";
    if (boundaries.empty() && !implicit)
      return unknown(face, reader_.error(record.instance, "it has no boundaries").error());
    if (implicit) {
      const auto whole = brep::whole_rectangle(model_, support);
      if (!whole) return unknown(face, whole.error());
      add_sides(support, *whole, face);
    }
    for (const std::uint32_t boundary : boundaries) {
      std::vector<SurfacePiece> pieces;
      if (auto read = pieces_.add(boundary, record.surface, support, pieces); !read)
        unknown(face, read.error());
      else
        add_bound(pieces, support, face);
    }
  }

  void add_bound(std::vector<SurfacePiece>& pieces, const brep::Support& support,
                 brep::Face& face) {
    if (pieces.empty()) return;  // of points: it bounds nothing
    brep::Bound bound =
        edges_.bound(pieces, support.uncertainty, group_,
                     [&](const SurfacePiece& piece, const brep::BoundaryEdges::Use& use) {
                       BoundaryEdge& edge = sources_[model_.edges[use.edge].id];
                       edge.fixed = edge.fixed || piece.fixed;
                       if (piece.fixed || piece.source.segment == no_instance) return;
                       auto& sources = piece.in_space ? edge.sources : edge.in_parameters;
                       sources.emplace_back(piece.source).turned = use.turned;
                     });
    bound.forward = face.same_sense;  // boundaries run round the normal of the surface
    face.bounds.push_back(std::move(bound));
  }

  /// A face whose boundary is not known must not pass for a whole one.
  static void unknown(brep::Face& face, Error error) {
    brep::Bound& bound = face.bounds.emplace_back();
    bound.kind = brep::Bound::Kind::edges;
    bound.wrong = brep::fault(std::move(error));
  }

  const Reader& reader_;
  brep::Model& model_;
  PieceReader pieces_;
  std::unordered_map<std::uint32_t, std::uint32_t> held_;
  std::uint64_t next_;
  brep::BoundaryEdges edges_;
  brep::BoundaryEdges::Group group_;
  BoundarySources sources_;
};

}  // namespace

BoundarySources bound_surfaces(const Reader& reader, const std::vector<FaceRecord>& faces,
                               brep::Model& model) {
  if (std::ranges::none_of(faces, &FaceRecord::is_surface)) return {};
  SurfaceBounds bounds(reader, model);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    if (faces[k].is_surface) bounds.add(faces[k], model.faces[k]);
  }
  return bounds.sources();
}

}  // namespace knead::step
