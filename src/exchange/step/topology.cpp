#include "topology.hpp"

#include <algorithm>
#include <unordered_map>

#include "faces.hpp"
#include "geometry.hpp"
#include "share.hpp"

namespace knead::step {
namespace {

using brep::Index;

brep::Record record_of(const Reader& reader, std::uint32_t instance) {
  const std::string label = reader.label(instance), id = name_of(reader, instance);
  return {id, label.size() > id.size() ? label.substr(id.size() + 1) : std::string(),
          reader.file().line(reader.file().instance(instance).bytes.begin)};
}

class TopologyReader {
 public:
  TopologyReader(const Reader& reader, const std::vector<std::uint32_t>& surfaces,
                 brep::Model& model)
      : reader_(reader), model_(model) {
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      splines_.emplace(surfaces[k], static_cast<Index>(k));
  }

  // ADVANCED_FACE or FACE_SURFACE → FACE_BOUND → EDGE_LOOP → ORIENTED_EDGE → EDGE_CURVE →
  // VERTEX_POINT (ISO 10303-42, clause 5.5), bottom up, so that what is shared is one object.
  // ORIENTED_EDGE(name, *, *, edge_element, orientation): its own ends are derived, and written as
  // asterisks. A flag counts as true unless it is .F., and a part that cannot be read is kept with
  // its fault: a face with one bad edge still has its surface.
  std::vector<std::uint32_t> read(const std::vector<FaceRecord>& faces) {
    read_edges();
    for (const FaceRecord& face : faces) add_face(face);
    read_supports();
    read_shells();
    return std::move(support_instances_);
  }

 private:
  /// EDGE(start, end) and EDGE_CURVE(geometry, same_sense).
  void read_edges() {
    const auto instances = reader_.file().named({"EDGE_CURVE"});
    std::vector<std::uint32_t> curves(instances.size(), no_instance);
    model_.edges.resize(instances.size());
    for (std::size_t k = 0; k < instances.size(); ++k) {
      const std::uint32_t instance = instances[k];
      edges_.emplace(instance, static_cast<Index>(k));
      brep::Edge& edge = model_.edges[k];
      edge.id = name_of(reader_, instance);
      const auto ends = reader_.attributes(instance, "EDGE", 1, 2);
      const auto attributes = reader_.attributes(instance, "EDGE_CURVE", 3, 2);
      const auto geometry = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
      const auto start = ends.empty() ? std::nullopt : reader_.reference(ends[0]);
      const auto end = ends.empty() ? std::nullopt : reader_.reference(ends[1]);
      if (!geometry || !start || !end) {
        edge.wrong = brep::fault(
            reader_.error(instance, "an EDGE_CURVE with two vertices is needed here").error());
        continue;
      }
      edge.start = vertex(*start);
      edge.end = vertex(*end);
      edge.same_sense = reader_.enumeration(attributes[1]) != "F";
      curves[k] = *geometry;
    }
    share(reader_, curves.size(), [&](const Reader& reader, std::size_t k) {
      if (curves[k] == no_instance) return;
      auto curve = read_curve(reader, curves[k]);
      if (curve)
        model_.edges[k].curve = std::make_shared<const brep::CurveGeometry>(*std::move(curve));
      else
        model_.edges[k].wrong = brep::fault(std::move(curve.error()));
    });
  }

  Index vertex(std::uint32_t instance) {
    const auto [at, fresh] =
        vertices_.try_emplace(instance, static_cast<Index>(model_.vertices.size()));
    if (!fresh) return at->second;
    brep::Vertex& made = model_.vertices.emplace_back(name_of(reader_, instance));
    made.of_one_use = reader_.file().instance(instance).uses == 1;
    const auto attributes = reader_.attributes(instance, "VERTEX_POINT", 1, 1);
    const auto geometry = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
    const auto place =
        geometry ? reader_.point(*geometry)
                 : Expected<Point>(reader_.error(instance, "a VERTEX_POINT is needed here"));
    if (place)
      made.place = *place;
    else
      made.wrong = brep::fault(place.error());
    return at->second;
  }

  void add_face(const FaceRecord& record) {
    brep::Face& face = model_.faces.emplace_back(record_of(reader_, record.instance));
    faces_.emplace(record.instance, static_cast<Index>(model_.faces.size() - 1));
    face.same_sense = record.same_sense;
    face.turned = record.turned;
    if (record.surface != no_instance) {
      const auto [at, fresh] =
          supports_.try_emplace(record.surface, static_cast<Index>(model_.supports.size()));
      if (fresh) {
        model_.supports.emplace_back(record_of(reader_, record.surface));
        support_instances_.push_back(record.surface);
      }
      face.support = at->second;
    }
    if (record.is_surface) return;
    for (const auto bound : reader_.references(record.bounds))
      face.bounds.push_back(read_bound(bound));
  }

  brep::Bound read_bound(std::uint32_t instance) {
    brep::Bound bound;
    const auto attributes = reader_.attributes(instance, "FACE_BOUND", 1, 2);
    const auto loop = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
    if (!loop) {
      bound.wrong = brep::fault(reader_.error(instance, "a FACE_BOUND is needed here").error());
      return bound;
    }
    bound.forward = reader_.enumeration(attributes[1]) != "F";
    if (reader_.is(*loop, "VERTEX_LOOP")) {
      bound.kind = brep::Bound::Kind::vertex;
      const auto at = reader_.attributes(*loop, "VERTEX_LOOP", 1, 1);
      if (const auto target = at.empty() ? std::nullopt : reader_.reference(at[0]))
        bound.vertex = vertex(*target);
    } else if (reader_.is(*loop, "POLY_LOOP")) {
      read_polygon(*loop, bound);
    } else {
      read_edge_loop(*loop, bound);
    }
    return bound;
  }

  void read_polygon(std::uint32_t loop, brep::Bound& bound) const {
    bound.kind = brep::Bound::Kind::polygon;
    const auto attributes = reader_.attributes(loop, "POLY_LOOP", 1, 1);
    for (const auto k :
         attributes.empty() ? std::vector<std::uint32_t>() : reader_.references(attributes[0])) {
      const auto point = reader_.point(k);
      if (point) {
        bound.polygon.push_back(*point);
      } else if (!bound.wrong) {
        bound.wrong = brep::fault(point.error());
      }
    }
  }

  void read_edge_loop(std::uint32_t loop, brep::Bound& bound) const {
    const auto path = reader_.attributes(loop, "PATH", 1, 1);
    if (!reader_.is(loop, "EDGE_LOOP") || path.empty()) {
      bound.wrong =
          brep::fault(reader_.error(loop, "a loop of a known form is needed here").error());
      return;
    }
    bound.kind = brep::Bound::Kind::edges;
    for (const auto oriented : reader_.references(path[0])) {
      const auto attributes = reader_.attributes(oriented, "ORIENTED_EDGE", 3, 2);
      const auto element = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
      const auto edge = element ? edges_.find(*element) : edges_.end();
      if (edge != edges_.end()) {
        bound.edges.push_back({edge->second, reader_.enumeration(attributes[1]) != "F"});
      } else if (!bound.wrong) {
        bound.wrong = brep::fault(
            element
                ? reader_.error(*element, "an EDGE_CURVE with two vertices is needed here").error()
                : reader_.error(oriented, "an ORIENTED_EDGE is needed here").error());
      }
    }
  }

  void read_supports() {
    for (std::size_t k = 0; k < support_instances_.size(); ++k) {
      brep::Support& support = model_.supports[k];
      if (const auto spline = splines_.find(support_instances_[k]); spline != splines_.end()) {
        support.spline = spline->second;
        continue;
      }
      const auto known =
          std::ranges::find(model_.unreadable, support.id, &brep::UnreadableSurface::id);
      if (known != model_.unreadable.end())
        support.wrong = brep::fault(known->reason);
      else
        read_form(reader_, support_instances_[k], support);
    }
  }

  void read_shells() {
    for (const auto k : reader_.file().named({"CLOSED_SHELL", "OPEN_SHELL"})) {
      const auto attributes = reader_.attributes(k, "CONNECTED_FACE_SET", 1, 1);
      if (attributes.empty()) continue;
      brep::Shell& shell = model_.shells.emplace_back(name_of(reader_, k));
      for (const auto face : reader_.references(attributes[0])) {
        if (const auto found = faces_.find(face); found != faces_.end())
          shell.faces.push_back(found->second);
      }
    }
  }

  const Reader& reader_;
  brep::Model& model_;
  std::unordered_map<std::uint32_t, Index> splines_, edges_, vertices_, faces_,
      supports_;  // by record
  std::vector<std::uint32_t> support_instances_;
};

}  // namespace

std::vector<std::uint32_t> read_topology(const Reader& reader,
                                         const std::vector<std::uint32_t>& surfaces,
                                         const std::vector<FaceRecord>& faces, brep::Model& model) {
  return TopologyReader(reader, surfaces, model).read(faces);
}

}  // namespace knead::step
