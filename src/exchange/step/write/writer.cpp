#include <algorithm>
#include <unordered_map>

#include "check.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/data.hpp"
#include "exchange/step/file.hpp"
#include "exchange/step/surfaces.hpp"
#include "surgeon.hpp"

namespace knead::step {
namespace {

Expected<std::size_t> find(const File::Data& data, const std::string& id) {
  const brep::Index found = data.model->surface_index(id);
  if (found != brep::none) return found;
  return std::unexpected(Error{ErrorKind::input, "no readable B-spline surface has this name", id,
                               "name one of those that `info` lists", data.records.name()});
}

// Rejects surfaces that can be computed with but not written to a record of the file.
Expected<void> writable(const Surface& before, const Surface& after) {
  if (before.rational() && !after.rational())
    return input_error("the weights of the file's surface are missing");
  for (int d = 0; d < 2; ++d) {
    if (after.knots(d) == before.knots(d)) continue;
    const int degree = after.knots(d).degree();
    if (after.knots(d).max_interior_multiplicity() > degree &&
        before.knots(d).max_interior_multiplicity() <= before.knots(d).degree()) {
      return input_error(
          "STEP knows no surface that is torn along a knot", d == 0 ? "direction u" : "direction v",
          "keep knots inside the domain to a multiplicity of " + std::to_string(degree));
    }
  }
  return {};
}

}  // namespace

Expected<std::string> File::with_control_points(std::span<const Edit> edits) const {
  std::vector<brep::Replacement> replacements;
  replacements.reserve(edits.size());
  for (const auto& edit : edits) {
    const auto k = find(*data_, edit.id);
    if (!k) return std::unexpected(k.error());
    auto surface = data_->model->surfaces[*k].surface.with_control_points(edit.control_points);
    if (!surface) {
      Error error = surface.error().within(edit.id);
      error.file = name();
      return std::unexpected(std::move(error));
    }
    replacements.push_back({edit.id, *std::move(surface)});
  }
  return with_surfaces(replacements);
}

namespace {

Expected<void> write_edges(const File::Data& data, const brep::MovedEdges& moved,
                           Surgeon& surgeon) {
  const auto instance_of = [&](const std::string& id) -> Expected<std::uint32_t> {
    const auto found = data.records.find(parse_instance_name(id).value_or(0));
    if (found) return *found;
    return std::unexpected(
        Error{ErrorKind::input, "nothing in the file has this name", id, {}, data.records.name()});
  };
  for (const brep::MovedEdge& edge : moved.edges) {
    if (const auto boundary = data.of.boundaries.find(edge.id);
        boundary != data.of.boundaries.end()) {
      surgeon.replace_boundary(boundary->second.sources, edge.curve);
      continue;
    }
    const auto instance = instance_of(edge.id);
    if (!instance) return std::unexpected(instance.error());
    if (auto status = surgeon.replace_curve(*instance, edge.curve); !status) return status;
  }
  for (const brep::MovedVertex& vertex : moved.vertices) {
    if (parse_instance_name(vertex.id).value_or(0) > data.records.largest_id())
      continue;  // where boundaries meet
    const auto instance = instance_of(vertex.id);
    if (!instance) return std::unexpected(instance.error());
    if (auto status = surgeon.move_vertex(*instance, vertex.place); !status) return status;
  }
  return {};
}

Expected<WantedCurves> write_curves(const File::Data& data,
                                    std::span<const CurveReplacement> curves, Surgeon& surgeon) {
  WantedCurves wanted;
  const auto wrong = [&](const std::string& id, std::string what, std::string remedy) {
    return std::unexpected(
        Error{ErrorKind::input, std::move(what), id, std::move(remedy), data.records.name()});
  };
  for (const auto& [id, after] : curves) {
    const auto found = std::ranges::find(data.model->curves, id, &brep::FreeCurve::id);
    if (found == data.model->curves.end()) {
      return wrong(id, "no free B-spline curve has this name",
                   "name one of those that `info` lists");
    }
    const auto k = static_cast<std::size_t>(found - data.model->curves.begin());
    const Curve& before = found->curve;
    if (same_spline(before, after)) continue;
    if (!wanted.emplace(k, &after).second)
      return wrong(id, "edited twice", "give one edit per curve");
    const KnotVector& knots = after.knots(0);
    if (knots != before.knots(0) && knots.max_interior_multiplicity() > knots.degree()) {
      return wrong(
          id, "STEP knows no curve that is torn along a knot",
          "keep knots inside the domain to a multiplicity of " + std::to_string(knots.degree()));
    }
    const auto instance = data.of.curves[k];
    const auto& refs = data.of.curve_point_refs[k];
    const bool same_net =
        before.knots() == after.knots() && same_bits(before.weights(), after.weights());
    auto status = same_net ? surgeon.move_points(instance, refs, before.control_points(),
                                                 after.control_points())
                           : surgeon.replace_net(instance, refs, before, after);
    if (!status) return std::unexpected(std::move(status.error()));
  }
  return wanted;
}

}  // namespace

// On the same knots and weights only points change, which leaves the record of the surface alone;
// on others its lists are written anew. Surfaces that are equal to the last bit are not touched,
// and if nothing is, the file's own bytes come back.
Expected<std::string> File::with_surfaces(std::span<const brep::Replacement> replacements,
                                          const brep::MovedEdges& moved,
                                          std::span<const CurveReplacement> curves) const {
  const auto& data = *data_;
  WantedSurfaces wanted;
  Surgeon surgeon(data.records);
  bool changed = false;
  for (const auto& [id, after] : replacements) {
    const auto k = find(data, id);
    if (!k) return std::unexpected(k.error());
    const auto& before = data.model->surfaces[*k].surface;
    if (!wanted.emplace(*k, &after).second) {
      return std::unexpected(
          Error{ErrorKind::input, "edited twice", id, "give one edit per surface", name()});
    }
    if (auto can = writable(before, after); !can) {
      Error error = can.error().within(id);
      error.file = name();
      return std::unexpected(std::move(error));
    }
    if (same_spline(before, after)) continue;
    changed = true;
    const auto instance = data.of.surfaces[*k];
    const auto refs = control_point_values(Reader(data.records), instance);
    const bool same_net =
        before.knots() == after.knots() && same_bits(before.weights(), after.weights());
    auto status = same_net ? surgeon.move_points(instance, refs, before.control_points(),
                                                 after.control_points())
                           : surgeon.replace_surface(instance, refs, before, after);
    if (!status) return std::unexpected(std::move(status.error()));
  }
  const auto wanted_curves = write_curves(data, curves, surgeon);
  if (!wanted_curves) return std::unexpected(wanted_curves.error());
  if (!changed && wanted_curves->empty() && moved.edges.empty() && moved.vertices.empty())
    return bytes();
  if (auto status = write_edges(data, moved, surgeon); !status)
    return std::unexpected(std::move(status.error()));
  return checked(surgeon.result(), data, wanted, *wanted_curves);
}

}  // namespace knead::step
