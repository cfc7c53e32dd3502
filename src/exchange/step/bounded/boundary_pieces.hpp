#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "brep/boundary_edges.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "exchange/step/entity.hpp"

namespace knead::step {

/// Where a COMPOSITE_CURVE_SEGMENT gets its curve in space from.
struct BoundarySource {
  std::uint32_t segment = no_instance;
  std::uint32_t parent = 0;             ///< the value of the segment that refers to its curve
  std::uint32_t carrier = no_instance;  ///< the SURFACE_CURVE that has the curve in space; none:
                                        ///< the segment refers to it
  std::uint32_t value = 0;              ///< that refers to the curve in space
  bool turned = false;                  ///< the curve runs against the edge
};

/// A curve of a boundary of a surface.
struct SurfacePiece : brep::BoundaryPiece {
  BoundarySource source;
  bool in_space = false;  ///< `source` says where; else it is given in parameters alone, or nothing
                          ///< can replace it
  bool fixed = false;     ///< nothing can replace it
};

/// Reads the boundaries of CURVE_BOUNDED_SURFACEs (ISO 10303-42): COMPOSITE_CURVE_ON_SURFACE,
/// BOUNDARY_CURVE and OUTER_BOUNDARY_CURVE, and other curves; of segments SURFACE_CURVE and PCURVE
/// with their subtypes, TRIMMED_CURVE, and curves with ends of their own.
class PieceReader {
 public:
  PieceReader(const Reader& reader, const brep::Model& model) : reader_(reader), model_(model) {}

  /// Adds the pieces of a boundary of a surface. Errors (input): a curve of an unknown type, or
  /// without ends; more pieces than a file of this size has.
  [[nodiscard]] Expected<void> add(std::uint32_t curve, std::uint32_t basis,
                                   const brep::Support& support, std::vector<SurfacePiece>& pieces);

 private:
  struct Surface {
    std::uint32_t basis = no_instance;
    const brep::Support* support = nullptr;
    std::array<double, 2> scale = {1, 1};        ///< from the file's parameters to the model's
    std::optional<brep::FaceSurface> form = {};  ///< of another surface than a B-spline
    [[nodiscard]] Expected<Point> at(const brep::Model& model, const Point& uv) const;
  };
  [[nodiscard]] Expected<void> add_composite(std::uint32_t curve, bool forward, const Surface& on,
                                             int depth, std::vector<SurfacePiece>& pieces);
  [[nodiscard]] Expected<void> add_segment(std::uint32_t segment, bool forward, const Surface& on,
                                           int depth, std::vector<SurfacePiece>& pieces);
  [[nodiscard]] Expected<SurfacePiece> piece(std::uint32_t curve, const Surface& on) const;
  [[nodiscard]] Expected<SurfacePiece> on_surface(std::uint32_t curve, const Surface& on) const;
  [[nodiscard]] Expected<SurfacePiece> lifted(std::uint32_t pcurve, const Surface& on) const;
  [[nodiscard]] Expected<Surface> surface(std::uint32_t basis, const brep::Support& support) const;

  const Reader& reader_;
  const brep::Model& model_;
  std::size_t pieces_ = 0;
};

/// What the parameters of a surface's record are to be multiplied by to be those of `FaceSurface`
/// and of B-splines: angles have the unit of the file, lines and extrusions count multiples of
/// their VECTORs. Errors (input): several units of angles.
[[nodiscard]] Expected<std::array<double, 2>> parameter_scale(const Reader& reader,
                                                              std::uint32_t surface,
                                                              const brep::Support& support);

}  // namespace knead::step
