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

class Subfigures {
 public:
  Subfigures(const File& file, brep::Model& model) : file_(file), model_(model) {}

  /// Fills the assembly of the model, and returns the instances that are left out.
  std::set<int> add() {
    model_.assembly = assembly();
    return std::move(unplaced_);
  }

 private:
  // Entities 308 (DEPTH, NAME, N, N pointers) and 408 (definition, X, Y, Z, S). Definitions are
  // parts of a graph, and instances its uses; instances in no definition are uses of a root that
  // holds nothing else.
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
      for (const int instance : definition.instances)
        use(graph, definition.part, definition.title, instance);
    }
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k);
      if (file_.entities()[k].type == 408 && !inside_.contains(number))
        use(graph, root, {}, number);
    }
    for (brep::Index k = 0; k <= root && !model_.units.empty(); ++k)
      graph[k].unit = model_.units.front();
    graph[root].product = true;
    brep::Assembly result;
    if (auto status = graph.place(model_.length_unit(), result); !status)
      return std::unexpected(status.error());
    fill(graph, result);
    return result;
  }

  struct Definition {
    std::string title;
    std::vector<int> members, instances;  ///< entities
    brep::Index part = brep::none;
  };

  /// Gives a definition the faces and surfaces in it, and notes the instances in it.
  void read_definition(int definition) {
    Definition& stored = definitions_[definition];
    const auto parameters = file_.parameters(definition);
    if (parameters && parameters->values.size() > 2) stored.title = string(parameters->values[2]);
    if (!parameters || parameters->values.size() < 4) return;
    const int count = integer(parameters->values[3]).value_or(0);
    for (int k = 0; k < count && static_cast<std::size_t>(k) + 4 < parameters->values.size(); ++k) {
      const int member = integer(parameters->values[static_cast<std::size_t>(k) + 4]).value_or(0);
      const Entity* entity = file_.find(member);
      if (entity == nullptr || ++items_seen_ > most_items) continue;
      stored.members.push_back(member);
      if (entity->type == 186 || entity->type == 514) add_faces(member, stored.members);
      if (entity->type != 408) continue;
      inside_.insert(member);
      stored.instances.push_back(member);
    }
  }

  /// The faces of a solid (186: its shell and that of each void, with flags) or a shell (514: their
  /// number, and of each whether it is turned).
  void add_faces(int number, std::vector<int>& faces) {
    const auto parameters = file_.parameters(number);
    if (!parameters) return;
    const auto pointer = [&](std::size_t k) {
      return k < parameters->values.size() ? integer(parameters->values[k]).value_or(0) : 0;
    };
    if (file_.find(number)->type == 186) {
      const auto add_shell = [&](std::size_t k) {
        const Entity* shell = file_.find(pointer(k));
        if (shell != nullptr && shell->type == 514) add_faces(pointer(k), faces);
      };
      add_shell(1);
      for (int k = 0; k < pointer(3) && ++items_seen_ <= most_items; ++k)
        add_shell(4 + 2 * static_cast<std::size_t>(k));
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
    if (!matrix || !brep::scale_of(matrix->linear())) return std::nullopt;
    return *matrix * Eigen::Translation3d(place) * Eigen::Scaling(scale);
  }

  void use(brep::PartGraph& graph, brep::Index parent, const std::string& title, int instance) {
    const auto parameters = file_.parameters(instance);
    const bool whole = parameters && parameters->values.size() >= 2;
    const auto definition =
        whole ? definitions_.find(integer(parameters->values[1]).value_or(0)) : definitions_.end();
    const auto move =
        definition != definitions_.end() ? move_of(instance, *parameters) : std::nullopt;
    if (!move) {
      unplaced_.insert(instance);
      return;
    }
    graph.use(parent, definition->second.part, *move);
    brep::Instance& made = model_.instances.emplace_back();
    made.id = fmt::format("#{}", instance);
    made.parent = title;
    made.child = definition->second.title;
  }

  /// Gives every part the faces of its definition and the surfaces below them, and what is in none
  /// to one of its own.
  void fill(brep::PartGraph& graph, brep::Assembly& result) {
    std::map<std::string, brep::Index> faces;
    for (brep::Index f = 0; f < model_.faces.size(); ++f) faces.emplace(model_.faces[f].id, f);
    for (const auto& [number, definition] : definitions_) {
      brep::PartGraph::Node& node = graph[definition.part];
      if (!node.product) continue;
      brep::Part part{definition.title, model_.length_unit(), {}, {}, {}, std::move(node.places)};
      for (const int member : std::set<int>(definition.members.begin(), definition.members.end())) {
        const std::string id = fmt::format("#{}", member);
        const auto face = faces.find(id);
        if (face != faces.end()) part.add(model_, face->second);
        // Surfaces without faces stand for themselves; others are shown by these.
        const brep::SplineSurface* surface = model_.find_surface(id);
        if (surface != nullptr && surface->faces == 0) part.surfaces.push_back(id);
      }
      if (!part.faces.empty() || !part.surfaces.empty()) result.parts.push_back(std::move(part));
    }
    brep::add_rest(model_, result);
  }

  const File& file_;
  brep::Model& model_;
  std::map<int, Definition> definitions_;
  std::set<int> inside_, unplaced_;  // instances: in definitions; that are left out
  std::size_t items_seen_ = 0;
};

}  // namespace

std::set<int> add_subfigures(const File& file, brep::Model& model) {
  if (std::ranges::find(file.entities(), 408, &Entity::type) == file.entities().end()) return {};
  return Subfigures(file, model).add();
}

}  // namespace knead::iges
