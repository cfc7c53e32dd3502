#include "tool_path.hpp"

namespace knead {

// Places are counted along the whole path: `rest`, the way since the last one, goes over from piece
// to piece, so that corners do not add places and a path in parts has those of the whole.
void ToolPath::go_to(const Point& point, std::vector<Point>& places) {
  if (!begun) {
    places.push_back(point);
    begun = true;
    end = point;
    return;
  }
  const double length = (point - end).norm();
  double way = spacing - rest;  // to the next place, from `end`
  for (; way <= length; way += spacing) places.push_back(end + way / length * (point - end));
  rest = length - (way - spacing);
  end = point;
}

void ToolPath::finish(std::vector<Point>& places) {
  if (!begun || rest == 0) return;
  places.push_back(end);
  rest = 0;
}

}  // namespace knead
