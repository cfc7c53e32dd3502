#pragma once

#include "tool_load_elements.hpp"

namespace knead {

/// The points of one element that a tool grips.
template <int D>
struct ToolLoad<D>::Gripping {
  const ToolLoad& load;
  const Points& x;
  int first;
  const ModelTool& tool;
  bool cut;  // by the edges of the visible part
  Element element;
  FrictionAnchors& result;

  [[nodiscard]] bool skip(const Point&, const Point&) const { return false; }
  [[nodiscard]] unsigned reached(const double*, std::ptrdiff_t) const { return ~0U; }
  [[nodiscard]] double clear(const Sample&) const { return 0; }
  [[nodiscard]] double act(const Sample& whole) const {
    if (!cut) return at(whole);
    load.for_what_is_seen(whole, x, first, [&](const Sample& s) { at(s); });
    return 0;
  }

 private:
  double at(const Sample& s) const {
    const ToolAction action = tool.action(s.place);
    if (!action.active) return action.clear;
    std::ptrdiff_t& begin = result.elements[static_cast<std::size_t>(load.number(element))];
    if (begin < 0) {
      begin = static_cast<std::ptrdiff_t>(result.index.size());
      result.index.resize(result.index.size() + static_cast<std::size_t>(points(element)), -1);
    }
    int& at = result.index[static_cast<std::size_t>(begin + index(element, s.at))];
    const FrictionAnchors::Anchor anchor{tool.tool().friction * action.force.norm(), action.normal,
                                         s.place};
    if (at < 0) {
      at = static_cast<int>(result.anchors.size());
      result.anchors.push_back(anchor);
    } else if (anchor.grip > result.anchors[static_cast<std::size_t>(at)].grip) {
      result.anchors[static_cast<std::size_t>(at)] = anchor;  // of two tools the stronger one grips
    }
    return 0;
  }
};

}  // namespace knead
