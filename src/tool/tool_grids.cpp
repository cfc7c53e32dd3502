#include <optional>
#include <utility>

#include "tool_load.hpp"

namespace knead {

template <int D>
Expected<ToolGrids<D>> ToolGrids<D>::create(const Spline<D>& spline,
                                            const DomainScaling<D>& scaling, double detail) {
  auto finest = ToolLoad<D>::create(spline, scaling, detail);
  if (!finest) return std::unexpected(finest.error());
  ToolGrids result;
  for (std::optional<ToolLoad<D>> next = std::move(*finest); next;) {
    result.grids_.push_back(std::move(*next));
    next = result.grids_.back().split();
  }
  return result;
}

template <int D>
void ToolGrids<D>::show(const std::shared_ptr<const VisibleRegion>& region) {
  for (ToolLoad<D>& grid : grids_) grid.show(region);
}

template class ToolGrids<1>;
template class ToolGrids<2>;
template class ToolGrids<3>;

}  // namespace knead
