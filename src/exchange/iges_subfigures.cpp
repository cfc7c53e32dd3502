#include "iges_subfigures.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "iges_geometry.hpp"
#include "part21_text.hpp"

namespace knead::iges {
namespace {

constexpr std::size_t most_items = 10'000'000;  // of all definitions together
constexpr double most_shear = 1e-9;             // of a matrix of rotation, as far as files print one

class Subfigures {
 public:
  Subfigures(const File& file, const std::set<int>& shown, std::string context, step::StepRecords& records)
      : file_(file), shown_(shown), context_(std::move(context)), records_(records) {}

  void add() {
    std::vector<int> instances;
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k), type = file_.entities()[k].type;
      if (type == 408) instances.push_back(number);
      if (type == 308) definitions_.push_back(number);
    }
    if (instances.empty()) return;
    std::set<int> inside;
    for (const int definition : definitions_) {
      std::string list;
      for (const int item : items_of(definition, inside)) append(list, item);
      const auto parameters = file_.parameters(definition);
      const std::string title = parameters && parameters->values.size() > 2 ? string(parameters->values[2]) : "";
      representations_[definition] = {title, list};
    }
    write(instances, inside);
  }

 private:
  struct Representation {
    std::string title, items;
  };

  static void append(std::string& list, int record) { list += (list.empty() ? "#" : ",#") + std::to_string(record); }

  /// The entities of a definition that are shown, and the records of the instances in it.
  std::vector<int> items_of(int definition, std::set<int>& inside) {
    std::vector<int> result;
    const auto parameters = file_.parameters(definition);
    if (!parameters || parameters->values.size() < 4) return result;
    const int count = integer(parameters->values[3]).value_or(0);
    for (int k = 0; k < count && static_cast<std::size_t>(k) + 4 < parameters->values.size(); ++k) {
      const int member = integer(parameters->values[static_cast<std::size_t>(k) + 4]).value_or(0);
      const Entity* entity = file_.find(member);
      if (entity == nullptr || ++items_seen_ > most_items) continue;
      if (shown_.contains(member)) result.push_back(member);
      if (entity->type == 186 || entity->type == 514) add_faces(member, result);
      if (entity->type != 408) continue;
      inside.insert(member);
      nested_[definition].push_back(member);
    }
    return result;
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
      if (shown_.contains(face)) faces.push_back(face);
    }
  }

  /// The record of an instance; 0: it cannot be placed.
  int mapped(int instance, const std::map<int, int>& maps) {
    const auto parameters = file_.parameters(instance);
    if (!parameters || parameters->values.size() < 2) return 0;
    const auto map = maps.find(integer(parameters->values[1]).value_or(0));
    if (map == maps.end()) return 0;
    Point place = Point::Zero();
    double scale = 1;
    for (std::size_t k = 2; k < 6 && k < parameters->values.size(); ++k) {
      const auto value = real(parameters->values[k]);
      if (!value || !std::isfinite(*value)) return 0;
      if (k < 5) place[static_cast<Eigen::Index>(k) - 2] = *value;
      if (k == 5 && !parameters->values[k].empty()) scale = *value;
    }
    if (!(scale > 0)) return 0;
    // The instance's matrix moves what its place and scale have moved. STEP has no operator that shears.
    const auto matrix = transform_of(file_, instance);
    if (!matrix) return 0;
    const Eigen::Matrix3d turn = matrix->linear();
    const double length = std::cbrt(std::abs(turn.determinant()));
    const Eigen::Matrix3d off = turn.transpose() * turn - length * length * Eigen::Matrix3d::Identity();
    if (!(off.norm() <= most_shear * length * length)) return 0;
    std::array<std::string, 3> axes = {"$", "$", "$"};
    for (Eigen::Index k = 0; k < 3 && !turn.isIdentity(0); ++k)
      axes[static_cast<std::size_t>(k)] = fmt::format("#{}", records_.direction(turn.col(k)));
    const int origin = records_.point(*matrix * place);
    const int target = records_.add(fmt::format("CARTESIAN_TRANSFORMATION_OPERATOR_3D('',{},{},#{},{},{})", axes[0],
                                                axes[1], origin, format_real(scale * length), axes[2]));
    return records_.add(fmt::format("MAPPED_ITEM('',#{},#{})", map->second, target));
  }

  void write(const std::vector<int>& instances, const std::set<int>& inside) {
    const int origin = records_.frame(Point::Zero(), Point::UnitZ(), Point::UnitX());
    // A definition's representation has the number of its entity, under which nothing else is written.
    std::map<int, int> maps;
    for (const int definition : definitions_) {
      maps[definition] = records_.add(fmt::format("REPRESENTATION_MAP(#{},#{})", origin, definition));
    }
    for (const auto& [definition, representation] : representations_) {
      std::string list = representation.items;
      for (const int instance : nested_[definition]) {
        if (const int item = mapped(instance, maps); item != 0) append(list, item);
      }
      records_.put(definition, fmt::format("SHAPE_REPRESENTATION({},({}),{})", encode_string(representation.title),
                                           list, context_));
    }
    std::string root;
    for (const int instance : instances) {
      if (inside.contains(instance)) continue;
      if (const int item = mapped(instance, maps); item != 0) append(root, item);
    }
    records_.add(fmt::format("SHAPE_REPRESENTATION('',({}),{})", root, context_));
  }

  const File& file_;
  const std::set<int>& shown_;
  std::string context_;
  step::StepRecords& records_;
  std::vector<int> definitions_;
  std::map<int, std::vector<int>> nested_;
  std::map<int, Representation> representations_;
  std::size_t items_seen_ = 0;
};

}  // namespace

void add_subfigures(const File& file, const std::set<int>& shown, const std::string& context,
                    step::StepRecords& records) {
  Subfigures(file, shown, context, records).add();
}

}  // namespace knead::iges
