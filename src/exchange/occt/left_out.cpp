#include "left_out.hpp"

#include <algorithm>
#include <string>

#include "exchange/left_out_list.hpp"

namespace knead::occt {
namespace {

using detail::LeftOutKind;

class Unread {
 public:
  Unread(const BrepFile& file, std::size_t again)
      : file_(file), again_(again), seen_(file.shapes.size(), false) {}

  std::vector<LeftOut> list() {
    surface_used_.assign(file_.surfaces.size(), false);
    for (const Use& root : file_.roots) visit(root.shape);
    if (again_ > 0) {
      list_.add({"further use of a face", "further uses of faces",
                 "every face is shown once in one place, and is not sheared"},
                {}, again_);
    }
    add_unused();
    return list_.take();
  }

 private:
  [[nodiscard]] std::string name_of(std::size_t shape) const {
    return "#" + std::to_string(file_.surfaces.size() + shape + 1);
  }

  /// Shapes refer to earlier ones only: groups are not within themselves.
  void visit(std::size_t root) {
    std::vector<std::size_t> stack = {root};
    while (!stack.empty()) {
      const std::size_t index = stack.back();
      stack.pop_back();
      if (seen_[index]) continue;
      seen_[index] = true;
      const BrepShape& shape = file_.shapes[index];
      if (shape.kind == Shape::group) {
        for (auto use = shape.uses.rbegin(); use != shape.uses.rend(); ++use)
          stack.push_back(use->shape);
        continue;
      }
      if (shape.kind == Shape::face)
        add_face(index);
      else
        list_.add(loose(shape.kind), name_of(index));
    }
  }

  static LeftOutKind loose(Shape kind) {
    if (kind == Shape::vertex) return {"free vertex", "free vertices", "a point has no surface"};
    constexpr std::string_view reason = "no face is bounded by it";
    return kind == Shape::wire ? LeftOutKind{"free wire", "free wires", reason}
                               : LeftOutKind{"free edge", "free edges", reason};
  }

  void add_face(std::size_t index) {
    const BrepShape& face = file_.shapes[index];
    if (face.geometry > 0) surface_used_[static_cast<std::size_t>(face.geometry) - 1] = true;
    const bool bounded = std::ranges::any_of(face.uses, [&](const Use& wire) {
      const BrepShape& shape = file_.shapes[wire.shape];
      return shape.kind == Shape::wire && std::ranges::any_of(shape.uses, [&](const Use& use) {
               return file_.shapes[use.shape].kind == Shape::edge;
             });
    });
    constexpr std::string_view one = "face that cannot be read", many = "faces that cannot be read";
    if (face.geometry == 0)
      list_.add({one, many, "it has no surface, but triangles at most",
                 "write the file with exact geometry"},
                name_of(index));
    else if (!bounded)
      list_.add(
          {one, many, "it has no edges", "bound it by edges in the program that wrote the file"},
          name_of(index));
  }

  void add_unused() {
    for (std::size_t k = 0; k < file_.surfaces.size(); ++k) {
      if (!surface_used_[k] && !file_.surfaces[k].spline)
        list_.add({"surface without a face", "surfaces without faces",
                   "of surfaces that are no B-splines only what faces cover is shown"},
                  "#" + std::to_string(k + 1));
    }
    std::vector<bool> used(file_.curves.size(), false);
    for (const BrepShape& shape : file_.shapes) {
      if (shape.kind == Shape::edge && shape.geometry > 0 &&
          static_cast<std::size_t>(shape.geometry) <= used.size())
        used[static_cast<std::size_t>(shape.geometry) - 1] = true;
    }
    if (const auto unused = std::ranges::count(used, false); unused > 0) {
      list_.add({"curve without an edge", "curves without edges",
                 "curves are read where they bound faces"},
                {}, static_cast<std::size_t>(unused));
    }
  }

  const BrepFile& file_;
  std::size_t again_;
  std::vector<bool> seen_, surface_used_;
  detail::LeftOutList list_;
};

}  // namespace

std::vector<LeftOut> left_out(const BrepFile& file, std::size_t again) {
  return Unread(file, again).list();
}

}  // namespace knead::occt
