#include "new_faces.hpp"

#include <array>
#include <map>

#include "exchange/natural_faces.hpp"
#include "exchange/part21/part21_text.hpp"

namespace knead::step {
namespace {

std::string point_record(const Point& p) {
  return "CARTESIAN_POINT('',(" + format_real(p.x()) + "," + format_real(p.y()) + "," +
         format_real(p.z()) + "))";
}

std::string curve_record(const Curve& curve, const AddRecord& add) {
  std::vector<std::string> points;
  for (Eigen::Index k = 0; k < curve.size(); ++k) {
    points.push_back(add(point_record(curve.control_points().row(k).transpose())));
  }
  return add(print_curve(curve, "''", [&](int k) { return points[static_cast<std::size_t>(k)]; }));
}

void append(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ",") + item;
}

}  // namespace

Expected<NewFaces> add_faces(std::span<const NewSurface> surfaces,
                             std::span<const std::string> names, const AddRecord& add) {
  std::vector<const Surface*> shapes;
  for (const NewSurface& s : surfaces) shapes.push_back(&s.surface);
  const auto made = detail::natural_faces(shapes);
  if (!made) return std::unexpected(made.error());
  std::vector<std::string> vertices, edges;
  for (const Point& p : made->vertices)
    vertices.push_back(add("VERTEX_POINT(''," + add(point_record(p)) + ")"));
  for (const detail::NaturalEdge& e : made->edges) {
    edges.push_back(add("EDGE_CURVE(''," + vertices[static_cast<std::size_t>(e.from)] + "," +
                        vertices[static_cast<std::size_t>(e.to)] + "," +
                        curve_record(e.curve, add) + ",.T.)"));
  }
  NewFaces result;
  std::vector<std::string> shells(made->closed.size());
  for (std::size_t k = 0; k < made->faces.size(); ++k) {
    const detail::NaturalFace& face = made->faces[k];
    std::string loop;
    for (const auto& use : face.loop) {
      append(loop, add("ORIENTED_EDGE('',*,*," + edges[static_cast<std::size_t>(use.edge)] +
                       (use.forward ? ",.T.)" : ",.F.)")));
    }
    const std::string sense = face.flipped ? ",.F.)" : ",.T.)";
    const auto bound = add("FACE_OUTER_BOUND(''," + add("EDGE_LOOP('',(" + loop + "))") + sense);
    result.faces.push_back(add("ADVANCED_FACE(" + encode_string(surfaces[k].name) + ",(" + bound +
                               ")," + names[k] + sense));
    append(shells[static_cast<std::size_t>(face.shell)], result.faces.back());
  }
  std::string list;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    append(list,
           add((made->closed[k] ? "CLOSED_SHELL('',(" : "OPEN_SHELL('',(") + shells[k] + "))"));
  }
  result.model = add("SHELL_BASED_SURFACE_MODEL('',(" + list + "))");
  return result;
}

// The chain that ISO 10303-46 demands from an item to a colour, one style for each colour; a file
// without the representation at its end shows none of them in most programs.
void add_colours(std::span<const Coloured> all, const std::string& context, const AddRecord& add) {
  std::map<std::array<double, 3>, std::string> styles;
  std::string items;
  for (const auto& [item, c] : all) {
    std::string& style = styles[c];
    if (style.empty()) {
      const auto colour = add("COLOUR_RGB(''," + format_real(c[0]) + "," + format_real(c[1]) + "," +
                              format_real(c[2]) + ")");
      const auto fill =
          add("FILL_AREA_STYLE('',(" + add("FILL_AREA_STYLE_COLOUR(''," + colour + ")") + "))");
      const auto side =
          add("SURFACE_SIDE_STYLE('',(" + add("SURFACE_STYLE_FILL_AREA(" + fill + ")") + "))");
      style = add("PRESENTATION_STYLE_ASSIGNMENT((" +
                  add("SURFACE_STYLE_USAGE(.BOTH.," + side + ")") + "))");
    }
    append(items, add("STYLED_ITEM('',(" + style + ")," + item + ")"));
  }
  if (!items.empty()) {
    add("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(" + items + ")," + context +
        ")");
  }
}

}  // namespace knead::step
