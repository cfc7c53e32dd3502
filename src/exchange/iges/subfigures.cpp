#include "subfigures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "brep/part_graph.hpp"
#include "geometry.hpp"

namespace knead::iges {
namespace {

constexpr std::size_t most_items = 10'000'000;  // of all definitions together
constexpr double most_shear = 1e-9;             // of a matrix of rotation, as far as files print one

class Subfigures {
 public:
  Subfigures(const File& file, brep::Model& model) : file_(file), model_(model) {}

  Expected<brep::Assembly> assembly() {
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      if (file_.entities()[k].type == 308) read_definition(File::number(k));
    }
    brep::PartGraph graph(definitions_.size() + 1);
    brep::Index next = 0;
    for (auto& [number, definition] : definitions_) definition.part = next++;
    const brep::Index root = next;
    for (const auto& [number, definition] : definitions_) {
      graph[definition.part].name = definition.title;
      for (const int instance : definition.instances) use(graph, definition.part, definition.title, instance);
    }
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k);
      if (file_.entities()[k].type == 408 && !inside_.contains(number)) use(graph, root, {}, number);
    }
    for (brep::Index k = 0; k <= root && !model_.units.empty(); ++k) graph[k].unit = model_.units.front();
    graph[root].product = true;
    brep::Assembly result;
    if (auto done = graph.place(model_.length_unit(), result); !done) return std::unexpected(done.error());
    fill(graph, result);
    return result;
  }

 private:
  struct Definition {
    std::string title;
    std::vector<int> members, instances;  ///< entities
    brep::Index part = brep::none;
  };

  /// Gives a definition the faces and surfaces in it, and notes the instances in it.
  void read_definition(int definition) {
    Definition& own = definitions_[definition];
    const auto parameters = file_.parameters(definition);
    if (parameters && parameters->values.size() > 2) own.title = string(parameters->values[2]);
    if (!parameters || parameters->values.size() < 4) return;
    const int count = integer(parameters->values[3]).value_or(0);
    for (int k = 0; k < count && static_cast<std::size_t>(k) + 4 < parameters->values.size(); ++k) {
      const int member = integer(parameters->values[static_cast<std::size_t>(k) + 4]).value_or(0);
      const Entity* entity = file_.find(member);
      if (entity == nullptr || ++items_seen_ > most_items) continue;
      own.members.push_back(member);
      if (entity->type == 186 || entity->type == 514) add_faces(member, own.members);
      if (entity->type != 408) continue;
      inside_.insert(member);
      own.instances.push_back(member);
    }
  }

  /// The faces of a solid (186: shell) or a shell (514: their number, and of each whether it is turned).
  void add_faces(int number, std::vector<int>& faces) {
    const auto parameters = file_.parameters(number);
    if (!parameters) return;
    const auto pointer = [&](std::size_t k) {
      return k < parameters->values.size() ? integer(parameters->values[k]).value_or(0) : 0;
    };
    if (file_.find(number)->type == 186) {
      const Entity* shell = file_.find(pointer(1));
      if (shell != nullptr && shell->type == 514) add_faces(pointer(1), faces);
      return;
    }
    for (int k = 0; k < pointer(1) && ++items_seen_ <= most_items; ++k) {
      const int face = pointer(2 + 2 * static_cast<std::size_t>(k));
      faces.push_back(face);
    }
  }

  /// How an instance moves its definition; none: it cannot be placed.
  std::optional<Eigen::Affine3d> move_of(int instance, const Parameters& parameters) const {
    Point place = Point::Zero();
    double scale = 1;
    for (std::size_t k = 2; k < 6 && k < parameters.values.size(); ++k) {
      const auto value = real(parameters.values[k]);
      if (!value || !(std::abs(*value) <= largest_number)) return std::nullopt;
      if (k < 5) place[static_cast<Eigen::Index>(k) - 2] = *value;
      if (k == 5 && !parameters.values[k].empty()) scale = *value;
    }
    if (!(scale > 0)) return std::nullopt;
    // The instance's matrix moves what its place and scale have moved. Parts are not sheared.
    const auto matrix = transform_of(file_, instance);
    if (!matrix) return std::nullopt;
    const Eigen::Matrix3d turn = matrix->linear();
    const double length = std::cbrt(std::abs(turn.determinant()));
    const Eigen::Matrix3d off = turn.transpose() * turn - length * length * Eigen::Matrix3d::Identity();
    if (!(off.norm() <= most_shear * length * length)) return std::nullopt;
    return *matrix * Eigen::Translation3d(place) * Eigen::Scaling(scale);
  }

  void use(brep::PartGraph& graph, brep::Index parent, const std::string& title, int instance) {
    const auto parameters = file_.parameters(instance);
    if (!parameters || parameters->values.size() < 2) return;
    const auto definition = definitions_.find(integer(parameters->values[1]).value_or(0));
    if (definition == definitions_.end()) return;
    const auto move = move_of(instance, *parameters);
    if (!move) return;
    graph.use(parent, definition->second.part, *move);
    brep::Instance& made = model_.instances.emplace_back();
    made.id = fmt::format("#{}", instance);
    made.parent = title;
    made.child = definition->second.title;
  }

  /// Gives every part the faces of its definition and the surfaces below them, and what is in none to one of its own.
  void fill(brep::PartGraph& graph, brep::Assembly& result) {
    std::map<std::string, const brep::Face*> faces;
    for (const brep::Face& face : model_.faces) faces.emplace(face.id, &face);
    std::set<std::string> held;
    for (const auto& [number, definition] : definitions_) {
      brep::PartGraph::Node& node = graph[definition.part];
      if (!node.product) continue;
      std::set<int> members(definition.members.begin(), definition.members.end());
      brep::Part part{definition.title, model_.length_unit(), {}, {}, {}, std::move(node.places)};
      for (const int member : members) {
        const std::string id = fmt::format("#{}", member);
        const auto face = faces.find(id);
        const brep::SplineSurface* below =
            face == faces.end() ? model_.find_surface(id) : model_.spline_under(*face->second);
        if (face != faces.end()) part.faces.push_back(id);
        // Surfaces without faces stand for themselves; others are shown by these.
        const bool listed = below != nullptr && (face != faces.end() || below->faces == 0);
        if (listed && std::ranges::find(part.surfaces, below->id) == part.surfaces.end())
          part.surfaces.push_back(below->id);
      }
      held.insert(part.faces.begin(), part.faces.end());
      held.insert(part.surfaces.begin(), part.surfaces.end());
      if (!part.faces.empty() || !part.surfaces.empty()) result.parts.push_back(std::move(part));
    }
    brep::Assembly rest = brep::single_part(model_);
    for (brep::Part& part : rest.parts) {
      std::erase_if(part.faces, [&](const std::string& id) { return held.contains(id); });
      std::erase_if(part.surfaces, [&](const std::string& id) { return held.contains(id); });
      if (!part.faces.empty() || !part.surfaces.empty()) result.parts.push_back(std::move(part));
    }
  }

  const File& file_;
  brep::Model& model_;
  std::map<int, Definition> definitions_;
  std::set<int> inside_;  // instances in definitions
  std::size_t items_seen_ = 0;
};

}  // namespace

void add_subfigures(const File& file, brep::Model& model) {
  if (std::ranges::find(file.entities(), 408, &Entity::type) == file.entities().end()) return;
  model.assembly = Subfigures(file, model).assembly();
}

}  // namespace knead::iges
