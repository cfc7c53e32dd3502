// Pictures of a model coloured by the deviation at its data.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "brep/tessellation/model_mesh.hpp"
#include "morph_page.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

constexpr int side = 640, margin = 20;  // of one view, pixels
constexpr int finer = 2;                // samples per pixel in each direction

/// Where space is on a picture: right, up, towards the viewer.
struct View {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // rows
  Vector2d middle = Vector2d::Zero();
  double samples_per_length = 1;

  static View from(const Point& viewer) {
    View view;
    const Point right = Point::UnitZ().cross(viewer).normalized();
    view.axes << right.transpose(), viewer.cross(right).normalized().transpose(),
        viewer.normalized().transpose();
    return view;
  }
  /// Column, row downwards, and height towards the viewer.
  [[nodiscard]] Point at(const Point& p) const {
    const Point q = axes * p;
    constexpr double half = finer * side / 2.0;
    return {half + (q.x() - middle.x()) * samples_per_length,
            half - (q.y() - middle.y()) * samples_per_length, q.z() * samples_per_length};
  }
};

/// The view of four, from above, in which most of the triangles' area is seen.
View best_view(const std::vector<FaceMesh>& faces) {
  static const std::array<Point, 4> viewers = {Point(1, -1, 0.8), Point(-1, -1, 0.8),
                                               Point(1, 1, 0.8), Point(-1, 1, 0.8)};
  std::array<double, 4> seen{};
  for (const FaceMesh& face : faces) {
    for (const auto& t : face.triangles) {
      const Point& a = face.points[t[0]];
      const Point area = (face.points[t[1]] - a).cross(face.points[t[2]] - a);
      for (std::size_t k = 0; k < 4; ++k) seen[k] += std::abs(area.dot(viewers[k]));
    }
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (seen[k] > 1.001 * seen[best]) best = k;  // of equal ones the first
  }
  return View::from(viewers[best]);
}

/// The view that fits all triangles.
void fit(View& view, const std::vector<FaceMesh>& faces) {
  Eigen::AlignedBox2d box;
  for (const FaceMesh& face : faces) {
    for (const Point& p : face.points) box.extend(Vector2d((view.axes * p).head<2>()));
  }
  view.middle = box.center();
  view.samples_per_length = finer * (side - 2 * margin) / std::max(box.sizes().maxCoeff(), 1e-300);
}

/// What each sample of a picture shows.
struct Samples {
  static constexpr int width = finer * side;
  std::vector<double> height =
      std::vector<double>(std::size_t{width} * width, -std::numeric_limits<double>::infinity());
  std::vector<float> light = std::vector<float>(height.size(), 0);
  std::vector<int> surface = std::vector<int>(height.size(), -2);  // -2: nothing; -1: none
  std::vector<int> datum = std::vector<int>(height.size(), -1);    // the nearest

  static std::size_t at(int column, int row) {
    return static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
  }
  static int clamped(double x) { return static_cast<int>(std::clamp<double>(x, 0, width - 1)); }
};

/// Draws a triangle where it is in front of what is drawn already.
void draw(const FaceMesh& face, const std::array<std::uint32_t, 3>& t, int surface,
          const View& view, Samples& samples) {
  std::array<Point, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = view.at(face.points[t[k]]);
  const Vector2d a = (p[1] - p[0]).head<2>(), b = (p[2] - p[0]).head<2>();
  const double area = a.x() * b.y() - a.y() * b.x();
  if (area == 0) return;
  const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  for (int row = Samples::clamped(top - 0.5); row <= Samples::clamped(bottom + 0.5); ++row) {
    for (int column = Samples::clamped(left - 0.5); column <= Samples::clamped(right + 0.5);
         ++column) {
      const Vector2d d(column + 0.5 - p[0].x(), row + 0.5 - p[0].y());
      const double v = (d.x() * b.y() - d.y() * b.x()) / area,
                   w = (a.x() * d.y() - a.y() * d.x()) / area, u = 1 - v - w;
      if (std::min({u, v, w}) < -1e-9) continue;
      const double height = u * p[0].z() + v * p[1].z() + w * p[2].z();
      const std::size_t k = Samples::at(column, row);
      if (height <= samples.height[k]) continue;
      const Point normal = u * face.normals[t[0]] + v * face.normals[t[1]] + w * face.normals[t[2]];
      const double facing = std::abs(view.axes.row(2).dot(normal)) / std::max(normal.norm(), 1e-9);
      samples.height[k] = height;
      samples.light[k] = static_cast<float>(0.65 + 0.35 * facing);
      samples.surface[k] = surface;
    }
  }
}

/// How far, in samples, the points on each surface are from each other, several times over.
std::vector<double> radii_of(const std::vector<MorphedPoint>& points, const Samples& samples,
                             std::size_t surfaces) {
  std::vector<double> seen(surfaces, 0), count(surfaces, 0);
  for (const int surface : samples.surface) {
    if (surface >= 0) ++seen[static_cast<std::size_t>(surface)];
  }
  for (const MorphedPoint& p : points) ++count[static_cast<std::size_t>(p.surface)];
  std::vector<double> result;
  for (std::size_t k = 0; k < surfaces; ++k) {
    // Points in rows are up to three times as far from each other as evenly spread ones.
    const double usual = std::sqrt(seen[k] / std::max(count[k], 1.0));
    result.push_back(std::clamp(3 * usual, 2.0 * finer, 64.0 * finer));
  }
  return result;
}

/// Gives every sample the nearest datum on its surface, within such a distance.
void spread(const std::vector<MorphedPoint>& points, std::size_t surfaces, const View& view,
            Samples& samples) {
  const std::vector<double> radii = radii_of(points, samples, surfaces);
  std::vector<float> nearest(samples.datum.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = view.at({points[i].place[0], points[i].place[1], points[i].place[2]});
    const double radius = radii[static_cast<std::size_t>(points[i].surface)];
    const int left = Samples::clamped(p.x() - radius), right = Samples::clamped(p.x() + radius);
    const int top = Samples::clamped(p.y() - radius), bottom = Samples::clamped(p.y() + radius);
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        const std::size_t k = Samples::at(column, row);
        if (samples.surface[k] != points[i].surface) continue;
        // In space, so that the far side of a closed surface does not count.
        const Point way(column + 0.5 - p.x(), row + 0.5 - p.y(), samples.height[k] - p.z());
        const auto distance = static_cast<float>(way.norm());
        if (way.head<2>().norm() > radius || distance > 3 * radius || distance >= nearest[k])
          continue;
        nearest[k] = distance;
        samples.datum[k] = static_cast<int>(i);
      }
    }
  }
}

/// Two views side by side, coloured by a value from −limit to limit.
MorphPicture picture(std::string name, const std::vector<MorphedPoint>& points,
                     double MorphedPoint::*value, double limit,
                     const std::array<Samples, 2>& views) {
  MorphPicture result{std::move(name), 2 * side, side, {}};
  const auto colour_at = [&](const Samples& view, std::size_t k) -> std::array<double, 3> {
    if (view.surface[k] == -2) return {255, 255, 255};
    std::array<double, 3> colour = {120, 120, 120};
    if (view.datum[k] >= 0) {
      const double x = points[static_cast<std::size_t>(view.datum[k])].*value;
      colour = detail::colour_of(limit > 0 ? x / limit : 0);
    }
    for (double& c : colour) c *= view.light[k];
    return colour;
  };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < 2 * side; ++column) {
      const Samples& view = views[column < side ? 0 : 1];
      std::array<double, 3> sum{};
      for (int k = 0; k < finer * finer; ++k) {
        const auto colour = colour_at(
            view, Samples::at(finer * (column % side) + k % finer, finer * row + k / finer));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c] / (finer * finer);
      }
      for (const double c : sum)
        result.colours.push_back(static_cast<unsigned char>(std::lround(c)));
    }
  }
  return result;
}

}  // namespace

Expected<IllustratedPage> illustrated_page(const Source& opened, const MorphedFile& morphed) {
  const MorphReport& report = morphed.report;
  if (morphed.points.empty()) return IllustratedPage{morph_page(report), {}, {}};
  const auto model = opened.model();
  if (!model) return input_error("the file has no faces", opened.name(), "open a file with faces");
  const auto meshed = model_faces(*model);
  if (!meshed) return std::unexpected(meshed.error());
  std::map<std::string, int> number;  // of surfaces of the report, by themselves and their faces
  for (std::size_t k = 0; k < report.surfaces.size(); ++k) {
    number[report.surfaces[k].id] = static_cast<int>(k);
    for (const std::string& face : report.surfaces[k].faces) number[face] = static_cast<int>(k);
  }
  View front = best_view(meshed->faces);
  View back = View::from(-front.axes.row(2).transpose());
  std::array<Samples, 2> views;
  for (const auto& [view, samples] : {std::pair(&front, &views[0]), std::pair(&back, &views[1])}) {
    fit(*view, meshed->faces);
    for (const FaceMesh& face : meshed->faces) {
      auto found = number.find(face.id);
      if (found == number.end()) found = number.find(face.surface);
      for (const auto& triangle : face.triangles)
        draw(face, triangle, found == number.end() ? -1 : found->second, *view, *samples);
    }
    spread(morphed.points, report.surfaces.size(), *view, *samples);
  }
  const auto& points = morphed.points;
  const double limit = report.histogram_before.limit, remaining = report.histogram_after.limit;
  IllustratedPage page{detail::page_text(report, true),
                       {{"histogram.svg", detail::histogram_drawing(report)},
                        {"scale.svg", detail::scale_drawing(limit, report.unit)},
                        {"remaining_scale.svg", detail::scale_drawing(remaining, report.unit)}},
                       {}};
  page.pictures.push_back(picture("before.png", points, &MorphedPoint::before, limit, views));
  page.pictures.push_back(picture("after.png", points, &MorphedPoint::after, limit, views));
  page.pictures.push_back(picture("remaining.png", points, &MorphedPoint::after, remaining, views));
  return page;
}

}  // namespace knead
