#include "model.hpp"

#include <algorithm>

#include "assembly.hpp"
#include "brep/model_builder.hpp"
#include "faces.hpp"
#include "free_curves.hpp"
#include "geometry.hpp"
#include "instances.hpp"
#include "surfaces.hpp"
#include "tessellated.hpp"
#include "topology.hpp"
#include "units.hpp"

namespace knead::step {
namespace {

/// The contexts of a file, and the units that they give to records.
class Contexts {
 public:
  explicit Contexts(const Reader& reader) : reader_(reader), contexts_(read_unit_contexts(reader)) {
    one_unit_ = std::ranges::all_of(contexts_, [&](const UnitContext& context) {
      return context.unit.name == contexts_.front().unit.name;
    });
  }

  [[nodiscard]] const std::vector<UnitContext>& all() const { return contexts_; }
  [[nodiscard]] std::vector<int> of(const std::vector<std::uint32_t>& instances) const {
    return contexts_of(reader_, contexts_, instances);
  }
  /// What is not reached from any representation still has the file's unit if there is only one.
  [[nodiscard]] std::string unit(int context) const {
    if (context >= 0) return contexts_[static_cast<std::size_t>(context)].unit.name;
    return !contexts_.empty() && one_unit_ ? contexts_.front().unit.name : std::string("unknown");
  }
  [[nodiscard]] double uncertainty(int context) const {
    return context < 0 ? 0 : contexts_[static_cast<std::size_t>(context)].uncertainty;
  }

 private:
  const Reader& reader_;
  std::vector<UnitContext> contexts_;
  bool one_unit_ = true;
};

void read_surfaces(const Reader& reader, const Contexts& contexts, brep::Model& model,
                   ModelRecords& records) {
  const auto instances = b_spline_surfaces(reader);
  auto all = read_b_spline_surfaces(reader, instances);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k]) {
      records.surfaces.push_back(instances[k]);
      model.surfaces.push_back({.id = name_of(reader, instances[k]),
                                .name = reader.item_name(instances[k]),
                                .unit = {},
                                .surface = std::move(all[k]->surface)});
    } else {
      model.unreadable.push_back({name_of(reader, instances[k]), std::move(all[k].error())});
    }
  }
  const auto context_of = contexts.of(records.surfaces);
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    brep::SplineSurface& surface = model.surfaces[k];
    surface.unit = contexts.unit(context_of[k]);
    surface.uncertainty = contexts.uncertainty(context_of[k]);
  }
}

void read_curves(const Reader& reader, const Contexts& contexts, brep::Model& model,
                 ModelRecords& records) {
  std::vector<ReadCurve> curves = free_curves(reader);
  for (const ReadCurve& c : curves) records.curves.push_back(c.instance);
  const auto context_of = contexts.of(records.curves);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    records.curve_point_refs.push_back(std::move(curves[k].references));
    model.curves.push_back({name_of(reader, curves[k].instance),
                            reader.item_name(curves[k].instance), contexts.unit(context_of[k]),
                            std::move(curves[k].curve)});
  }
}

void read_tessellated(const Reader& reader, const Contexts& contexts, brep::Model& model,
                      ModelRecords& records) {
  records.tessellated = tessellated_records(reader);
  const std::vector<TessellatedRecord>& shown = records.tessellated.shown;
  if (shown.empty()) return;
  std::vector<std::uint32_t> instances;
  for (const TessellatedRecord& record : shown) instances.push_back(record.instance);
  const auto context_of = contexts.of(instances);
  TessellatedReader triangles(reader);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    auto mesh = triangles.mesh(shown[k]);
    if (!mesh) {
      model.tessellated.skipped.push_back(
          {name_of(reader, shown[k].instance), std::move(mesh.error())});
      continue;
    }
    model.tessellated.items.push_back(
        {shown[k].named == no_instance ? std::string() : reader.item_name(shown[k].named),
         contexts.unit(context_of[k]), *std::move(mesh)});
  }
}

}  // namespace

Expected<brep::Model> read_model(const Reader& reader, ModelRecords& records) {
  if (auto few = check_loop_uses(reader); !few) return std::unexpected(std::move(few.error()));
  brep::Model model;
  model.name = reader.file().name();
  const Contexts contexts(reader);
  for (const UnitContext& context : contexts.all()) model.units.push_back(context.unit);
  model.angle_units = plane_angle_units(reader);
  read_surfaces(reader, contexts, model, records);
  records.faces = read_faces(reader);
  const auto context_of =
      contexts.of(read_topology(reader, records.surfaces, records.faces, model));
  for (std::size_t k = 0; k < context_of.size(); ++k) {
    model.supports[k].uncertainty = contexts.uncertainty(context_of[k]);
  }
  records.boundaries = bound_surfaces(reader, records.faces, model);
  read_curves(reader, contexts, model, records);
  read_tessellated(reader, contexts, model, records);
  brep::complete(model);
  const Structure structure = read_structure(reader);
  for (const Component& component : structure.components)
    model.instances.push_back(component.instance);
  model.assembly = read_assembly(reader, structure, model, records);
  return model;
}

}  // namespace knead::step
