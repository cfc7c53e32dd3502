#include "part_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace knead::brep {
namespace {

constexpr std::size_t longest_path = 1000;  // characters; deeper ones keep their end

std::string below(const std::string& path, const std::string& name) {
  std::string result = path.empty() ? name : path + "/" + name;
  if (result.size() > longest_path) result = "…/" + name.substr(0, longest_path);
  return result;
}

}  // namespace

double unit_ratio(const LengthUnit& child, const LengthUnit& parent) {
  return child.metres > 0 && parent.metres > 0 ? child.metres / parent.metres : 1.0;
}

// M = s Q with Q orthogonal, exactly if MᵀM = s² I with s³ = |det M|.
std::optional<double> scale_of(const Eigen::Matrix3d& matrix) {
  constexpr double most_shear = 1e-9;
  const double length = std::cbrt(std::abs(matrix.determinant()));
  const Eigen::Matrix3d off =
      matrix.transpose() * matrix - length * length * Eigen::Matrix3d::Identity();
  if (!(off.norm() <= most_shear * length * length)) return std::nullopt;
  return length;
}

void PartGraph::use(Index parent, Index child, const Eigen::Affine3d& move) {
  nodes_[parent].down.push_back(uses_.size());
  uses_.push_back({parent, child, move});
}

/// Marks what hangs together with products; other parts, such as those of styles and views, place
/// nothing.
void PartGraph::mark() {
  std::deque<Index> ready;
  for (Index k = 0; k < nodes_.size(); ++k) {
    if (nodes_[k].product) ready.push_back(k);
  }
  if (ready.empty()) {
    for (const Use& use : uses_) {
      if (!std::exchange(nodes_[use.parent].product, true)) ready.push_back(use.parent);
    }
  }
  while (!ready.empty()) {
    const Index k = ready.front();
    ready.pop_front();
    for (const std::size_t u : nodes_[k].down) {
      ++nodes_[uses_[u].child].open;
      if (!std::exchange(nodes_[uses_[u].child].product, true)) ready.push_back(uses_[u].child);
    }
  }
}

std::vector<Index> PartGraph::roots(const std::string& unit, Assembly& result) {
  std::vector<Index> found;
  const LengthUnit* model = nullptr;
  for (Index k = 0; k < nodes_.size(); ++k) {
    Node& node = nodes_[k];
    if (!node.product || node.open > 0) continue;
    if (model == nullptr && !node.unit.name.empty()) model = &node.unit;
    PartPlace root{node.name};
    if (model != nullptr) root.to_model.scale(unit_ratio(node.unit, *model));
    node.places.push_back(std::move(root));
    found.push_back(k);
  }
  result.unit = model != nullptr ? model->name : unit;
  return found;
}

// Kahn's topological order: a part is placed when all its uses by parents are, so that its list of
// places is complete before its children inherit it. The number of places multiplies at each level
// and may grow exponentially in a short file, hence `max_places`. Parts in a cycle never become
// ready, and are placed once by themselves.
Expected<void> PartGraph::place(const std::string& unit, Assembly& result) {
  mark();
  const auto first = roots(unit, result);
  std::deque<Index> ready(first.begin(), first.end());
  std::size_t count = ready.size(), followed = 0;
  while (!ready.empty()) {
    const Index k = ready.front();
    ready.pop_front();
    ++followed;
    const std::vector<PartPlace> above = nodes_[k].places;
    for (const std::size_t u : nodes_[k].down) {
      Node& child = nodes_[uses_[u].child];
      count += above.size();
      if (count > max_places) {
        return input_error(fmt::format("the assembly has more than {} places of parts", max_places),
                           {}, "open the files of its parts");
      }
      for (const PartPlace& p : above) {
        child.places.push_back({below(p.path, child.name), p.to_model * uses_[u].move});
      }
      if (--child.open == 0) ready.push_back(uses_[u].child);
    }
  }
  const auto products = static_cast<std::size_t>(std::ranges::count(nodes_, true, &Node::product));
  if (followed == products) return {};
  // What is left hangs on an assembly within itself.
  result.warnings.emplace_back(
      "an assembly contains itself; its parts stand as far as they could be followed");
  for (Node& node : nodes_) {
    if (node.product && node.places.empty()) node.places.push_back({node.name});
  }
  return {};
}

}  // namespace knead::brep
