// Pictures of a model coloured by the deviation at its data.
#include <algorithm>
#include <cmath>
#include <deque>
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

/// How far the points on each surface of the report are from each other, several times over.
/// \param numbers of these surfaces, of each face; -1: none
std::vector<double> reaches_of(const std::vector<MorphedPoint>& points, std::size_t surfaces,
                               const std::vector<FaceMesh>& faces,
                               const std::vector<int>& numbers) {
  std::vector<double> area(surfaces, 0), count(surfaces, 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (numbers[f] < 0) continue;
    for (const auto& t : faces[f].triangles) {
      const auto& p = faces[f].points;
      area[static_cast<std::size_t>(numbers[f])] +=
          (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm() / 2;
    }
  }
  for (const MorphedPoint& p : points) ++count[static_cast<std::size_t>(p.surface)];
  constexpr double rows = 4;  // points in rows are farther from each other than evenly spread ones
  for (std::size_t k = 0; k < surfaces; ++k)
    area[k] = rows * std::sqrt(area[k] / std::max(count[k], 1.0));
  return area;
}

/// Gives every sample the nearest datum on its surface, within the reach of that: from samples that
/// have one to their neighbours.
class Spreading {
 public:
  Spreading(const std::vector<MorphedPoint>& points, const std::vector<double>& reaches,
            const View& view, Samples& samples)
      : points_(points), reaches_(reaches), samples_(samples) {
    for (const MorphedPoint& p : points)
      places_.push_back(view.at({p.place[0], p.place[1], p.place[2]}));
    for (double& reach : reaches_)
      reach = std::clamp(reach * view.samples_per_length, 2.0 * finer, 64.0 * finer);
  }

  void run() {
    constexpr double beside = 6;  // that steep faces and chords are off by, in samples
    for (std::size_t i = 0; i < points_.size(); ++i) around(places_[i], i, beside);
    while (!changed_.empty()) {
      const std::size_t k = changed_.front();
      changed_.pop_front();
      const auto column = static_cast<double>(k % Samples::width),
                 row = static_cast<double>(k / Samples::width);
      around({column + 0.5, row + 0.5, 0}, static_cast<std::size_t>(samples_.datum[k]),
             std::numeric_limits<double>::infinity());
    }
  }

 private:
  /// Offers a datum to the sample at a place and to those around it.
  void around(const Point& at, std::size_t datum, double most) {
    const auto surface = points_[datum].surface;
    const double reach = std::min(most, reaches_[static_cast<std::size_t>(surface)]);
    const int left = Samples::clamped(at.x() - 1), right = Samples::clamped(at.x() + 1);
    const int top = Samples::clamped(at.y() - 1), bottom = Samples::clamped(at.y() + 1);
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        const std::size_t k = Samples::at(column, row);
        if (samples_.surface[k] != surface) continue;
        // In space, so that the far side of a closed surface does not count.
        const Point& p = places_[datum];
        const Point way(column + 0.5 - p.x(), row + 0.5 - p.y(), samples_.height[k] - p.z());
        const auto distance = static_cast<float>(way.norm());
        if (way.head<2>().norm() > reach || distance > 3 * reach || distance >= nearest_[k])
          continue;
        nearest_[k] = distance;
        samples_.datum[k] = static_cast<int>(datum);
        changed_.push_back(k);
      }
    }
  }

  const std::vector<MorphedPoint>& points_;
  std::vector<double> reaches_;  // in samples
  Samples& samples_;
  std::vector<Point> places_;
  std::vector<float> nearest_ =
      std::vector<float>(samples_.datum.size(), std::numeric_limits<float>::infinity());
  std::deque<std::size_t> changed_;
};

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
  std::vector<int> numbers;  // of each face
  for (const FaceMesh& face : meshed->faces) {
    auto found = number.find(face.id);
    if (found == number.end()) found = number.find(face.surface);
    numbers.push_back(found == number.end() ? -1 : found->second);
  }
  const std::vector<double> reaches =
      reaches_of(morphed.points, report.surfaces.size(), meshed->faces, numbers);
  View front = best_view(meshed->faces);
  View back = View::from(-front.axes.row(2).transpose());
  std::array<Samples, 2> views;
  for (const auto& [view, samples] : {std::pair(&front, &views[0]), std::pair(&back, &views[1])}) {
    fit(*view, meshed->faces);
    for (std::size_t f = 0; f < numbers.size(); ++f) {
      for (const auto& triangle : meshed->faces[f].triangles)
        draw(meshed->faces[f], triangle, numbers[f], *view, *samples);
    }
    Spreading(morphed.points, reaches, *view, *samples).run();
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
