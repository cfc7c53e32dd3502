#include "reshape.hpp"

#include <map>

#include "knead/base/error_code.hpp"
#include "knead/spline/extremum.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "lattice.hpp"
#include "mask.hpp"

namespace knead {
namespace {

using Shape2 = std::shared_ptr<const Surface>;

/// All shapes on the present basis except `opened`: those of the surface and those of its
/// constraints.
std::vector<Shape2*> shapes_of(SceneSurface& surface) {
  std::vector<Shape2*> shapes = {&surface.reference, &surface.rest, &surface.current};
  for (KeptConstraint& kept : surface.constraints) shapes.push_back(&kept.where);
  return shapes;
}

// Several shapes are often one object (reference, rest and the places of constraints before
// anything moved). Each object is changed once and its copies stay one object: models are compared
// by these pointers, and a second copy would make a model seem different.
Expected<void> replace(const std::vector<Shape2*>& shapes, const SurfaceChange& change) {
  std::map<const Surface*, Shape2> changed;
  for (Shape2* shape : shapes) {
    Shape2& made = changed[shape->get()];
    if (!made) {
      auto result = change(**shape);
      if (!result) return std::unexpected(result.error());
      made = std::make_shared<const Surface>(std::move(*result));
    }
    *shape = made;
  }
  return {};
}

Expected<void> check_pins(const SceneSurface& surface) {
  if (surface.pins.empty()) return {};
  return input_error("control points are pinned by their numbers, which change with the net",
                     surface.id, "release them first, or pin surface points (at) instead",
                     {ErrorCode::pins_by_number, {{"surface", surface.id}}});
}

/// The mask follows a change of the basis.
class MaskKept {
 public:
  explicit MaskKept(const SceneSurface& surface) {
    if (!surface.mask.empty()) field_ = mask_field(surface);
  }
  Expected<void> put_on(SceneSurface& surface) const {
    if (!field_) return {};
    if (!*field_) return std::unexpected(field_->error());
    auto mask = mask_on(**field_, *surface.current);
    if (!mask) return std::unexpected(mask.error());
    surface.mask = std::move(*mask);
    return {};
  }

 private:
  std::optional<Expected<Surface>> field_;
};

}  // namespace

// A mask has one number per control point. It is read as the coefficients of a scalar field and
// sampled on the new net; where the net keeps its size the numbers stand.
Expected<void> change_basis(SceneSurface& surface, const SurfaceChange& change) {
  const MaskKept mask(surface);
  const auto net = surface.current->net();
  if (auto status = replace(shapes_of(surface), change); !status) return status;
  return surface.current->net() == net ? Expected<void>() : mask.put_on(surface);
}

Expected<void> change_net(SceneSurface& surface, const SurfaceChange& change) {
  if (auto free = check_pins(surface); !free) return free;
  // The velocity is a spline on the present basis, as the shapes are.
  Points velocity = surface.velocity;
  if (velocity.rows() > 0) {
    auto field = surface.current->with_control_points(velocity);
    if (field) field = change(*field);
    if (!field) return std::unexpected(field.error());
    velocity = field->control_points();
  }
  const MaskKept mask(surface);
  auto shapes = shapes_of(surface);
  if (same_basis(*surface.opened, *surface.current)) shapes.push_back(&surface.opened);
  if (auto status = replace(shapes, change); !status) return status;
  surface.velocity = std::move(velocity);
  return mask.put_on(surface);
}

// Knots are removed from the present shape and, with the same linear maps, from the shapes beside
// it (reference, rest, opened, places of constraints), so that all remain on one basis and D = S −
// S_rest keeps its meaning. The bound is that of the present shape; each direction may use half of
// the tolerance, as their errors add up. Removal from a velocity has no bound worth having: the
// motion is stopped instead.
Expected<Coarsening> coarsen(SceneSurface& s, double tolerance) {
  if (auto free = check_pins(s); !free) return std::unexpected(free.error());
  Coarsening total;
  const MaskKept mask(s);
  for (int d = 0; d < 2; ++d) {
    // Each direction may use half of the tolerance.
    std::vector<Shape2*> shapes = {&s.reference, &s.rest};
    if (same_basis(*s.opened, *s.current)) shapes.push_back(&s.opened);
    for (KeptConstraint& kept : s.constraints) shapes.push_back(&kept.where);
    std::vector<Points> others;
    for (const Shape2* shape : shapes) others.push_back((*shape)->control_points());
    auto result = remove_knots<2>(*s.current, d, 0.5 * tolerance, others);
    if (!result) return std::unexpected(result.error());
    if (result->removed.empty()) continue;
    total.removed += result->removed.size();
    total.bound += result->error_bound;
    const auto current = std::make_shared<const Surface>(std::move(result->spline));
    std::map<const Surface*, Shape2> made = {{s.current.get(), current}};
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      Shape2& other = made[shapes[k]->get()];
      if (!other) {
        auto coarser = current->with_control_points(std::move(result->companions[k]));
        if (!coarser) return std::unexpected(coarser.error());
        other = std::make_shared<const Surface>(std::move(*coarser));
      }
    }
    for (Shape2* shape : shapes) *shape = made[shape->get()];
    s.current = current;
    total.stopped = total.stopped || s.velocity.rows() > 0;
    s.velocity.resize(0, 3);
  }
  if (auto put = mask.put_on(s); !put) return std::unexpected(put.error());
  return total;
}

Expected<Lattice> lattice_around(const std::vector<std::shared_ptr<const Surface>>& surfaces,
                                 double margin, const std::array<int, 3>& degree,
                                 const std::array<int, 3>& net) {
  if (surfaces.empty()) return input_error("no surface is selected", "surface", "select one");
  BoundingBox box;
  bool first = true;
  for (const auto& surface : surfaces) {
    const Points& points = surface->control_points();
    const Point lower = points.colwise().minCoeff().transpose(),
                upper = points.colwise().maxCoeff().transpose();
    box.lower = first ? lower : Point(box.lower.cwiseMin(lower));
    box.upper = first ? upper : Point(box.upper.cwiseMax(upper));
    first = false;
  }
  return Lattice::create(box, margin, degree, net);
}

Expected<Lattice> lattice_around_selection(const Scene& scene, double margin,
                                           const std::array<int, 3>& degree,
                                           const std::array<int, 3>& net) {
  std::vector<Shape2> surfaces;
  for (const int index : scene.selection()) {
    surfaces.push_back(scene.surfaces[static_cast<std::size_t>(index)].current);
  }
  return lattice_around(surfaces, margin, degree, net);
}

// A lattice remembers its pull so that a second one starts from the undeformed block. That is valid
// while nothing else moved the surfaces: compared by object, then by basis and control points,
// since undo and redo bring back equal shapes as other objects.
const PulledLattice* lattice_to_pull_on(const Scene& scene, double margin,
                                        const std::array<int, 3>& degree,
                                        const std::array<int, 3>& net) {
  if (!scene.lattice) return nullptr;
  const PulledLattice& lattice = *scene.lattice;
  const bool same_block =
      lattice.margin == margin && lattice.degree == degree && lattice.net == net;
  if (!same_block || lattice.surfaces != scene.selection()) return nullptr;
  for (std::size_t k = 0; k < lattice.surfaces.size(); ++k) {
    const Surface &left = *lattice.after[k],
                  &now = *scene.surfaces[static_cast<std::size_t>(lattice.surfaces[k])].current;
    if (&left == &now) continue;
    if (!same_basis(left, now) || left.control_points() != now.control_points()) return nullptr;
  }
  return &lattice;
}

}  // namespace knead
