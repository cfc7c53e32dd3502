#include "curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "brep/geometry_forms.hpp"
#include "brep/model_builder.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::iges {
namespace {

// Curves by their entities of IGES 5.3, whose parameters are
//   100 circular arc      ZT, X1, Y1 (centre), X2, Y2 (start), X3, Y3 (end), counter-clockwise
//   102 composite curve   N, N pointers
//   106 copious data      IP, N, then pairs with a common z, triples, or sextuples with directions
//   110 line              X1, Y1, Z1, X2, Y2, Z2
//   126 B-spline curve    K, M, PROP1-4, K + M + 2 knots, K + 1 weights, K + 1 points, V0, V1,
//   normal
// in the coordinates of the entity, which its transformation matrix (124) moves, as does that of
// each composite curve around it. K is the upper index of the control points.
constexpr int max_composite_nesting = 8;
constexpr double least_bytes_per_point = 1.5;  // of a file, and 10 kB beside it
constexpr std::size_t free_bytes = 10'000;

/// On a polygon, evenly by its corners.
Point along(const std::vector<Point>& points, double t) {
  const double place = t * static_cast<double>(points.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(place), points.size() - 2);
  const double share = place - static_cast<double>(k);
  return (1 - share) * points[k] + share * points[k + 1];
}

}  // namespace

bool CurveReader::exceeded() const {
  return least_bytes_per_point * static_cast<double>(points_) >
         static_cast<double>(file_.bytes().size() + free_bytes);
}

Expected<void> CurveReader::add(int number, const Eigen::Affine3d& outer,
                                std::vector<Piece>& pieces) {
  return add_nested(number, outer, pieces, 0);
}

Expected<void> CurveReader::add_nested(int number, const Eigen::Affine3d& outer,
                                       std::vector<Piece>& pieces, int depth) {
  const Entity* entity = file_.find(number);
  if (entity == nullptr) return file_.error(number, "there is no such curve");
  if (exceeded() || depth > max_composite_nesting) {
    return file_.error(number, "curves are nested too deeply, or used too often");
  }
  const auto transform = transform_of(file_, number);
  if (!transform) return std::unexpected(transform.error());
  const Eigen::Affine3d move = outer * *transform;
  if (entity->type == 102) {
    const auto parameters = file_.parameters(number);
    if (!parameters) return std::unexpected(parameters.error());
    const auto count =
        parameters->values.size() > 1 ? integer(parameters->values[1]) : std::nullopt;
    if (!count || *count < 1 || parameters->values.size() < 2 + static_cast<std::size_t>(*count)) {
      return file_.error(number, "its list of curves is incomplete", "get the whole file");
    }
    for (std::size_t k = 2; k < 2 + static_cast<std::size_t>(*count); ++k) {
      const int part = integer(parameters->values[k]).value_or(0);
      const Entity* other = file_.find(part);
      if (other != nullptr && (other->type == 116 || other->type == 132))
        continue;  // points between curves
      if (auto status = add_nested(part, move, pieces, depth + 1); !status) return status;
    }
    return {};
  }
  auto piece = entity->type == 100   ? arc(number, move)
               : entity->type == 110 ? line(number, move)
               : entity->type == 106 ? points(number, move)
               : entity->type == 126 ? spline(number, outer)
                                     : unknown(number, move);
  if (!piece) return std::unexpected(std::move(piece.error()));
  piece->number = number;
  piece->name = brep::ModelBuilder::name(number);
  piece->move = move;
  ++points_;
  pieces.push_back(*std::move(piece));
  return {};
}

/// A curve of a type that is not read.
Piece CurveReader::unknown(int number, const Eigen::Affine3d& move) const {
  Piece piece;
  piece.in_space = false;
  const Point origin = move.translation();
  piece.at = [origin](double) { return origin; };
  piece.geometry = file_.error(number, "curves of this type are not read");
  return piece;
}

Expected<Piece> CurveReader::arc(int number, const Eigen::Affine3d& move) const {
  const auto parameters = file_.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto v = numbers(file_, number, *parameters, 1, 7);  // z, centre, start, end
  if (!v) return std::unexpected(v.error());
  const auto& p = *v;
  const double radius = std::hypot(p[3] - p[1], p[4] - p[2]);
  if (!(radius > 0) || !std::isfinite(radius)) return file_.error(number, "its radius is 0");
  const double first = std::atan2(p[4] - p[2], p[3] - p[1]);
  double turn = std::atan2(p[6] - p[2], p[5] - p[1]) - first;
  // Equal ends, digit by digit, are a whole circle.
  if (p[3] == p[5] && p[4] == p[6])
    turn = 2 * std::numbers::pi;
  else if (turn <= 0)
    turn += 2 * std::numbers::pi;
  const Point centre = move * Point(p[1], p[2], p[0]), x = radius * move.linear().col(0),
              y = radius * move.linear().col(1);
  Piece piece;
  piece.geometry = brep::conic_of(brep::Conic::Form::ellipse, brep::frame_of(centre, x.cross(y), x),
                                  x.norm(), x.norm());
  piece.at = [=](double t) {
    return Point(centre + std::cos(first + t * turn) * x + std::sin(first + t * turn) * y);
  };
  return piece;
}

Expected<Piece> CurveReader::line(int number, const Eigen::Affine3d& move) const {
  const auto parameters = file_.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto v = numbers(file_, number, *parameters, 1, 6);
  if (!v) return std::unexpected(v.error());
  const Point a = move * Point((*v)[0], (*v)[1], (*v)[2]),
              b = move * Point((*v)[3], (*v)[4], (*v)[5]);
  if (a == b) return file_.error(number, "it is a line without length");
  Piece piece;
  piece.geometry = brep::line_of(a, b - a);
  piece.at = [a, b](double t) { return Point((1 - t) * a + t * b); };
  return piece;
}

Expected<Piece> CurveReader::points(int number, const Eigen::Affine3d& move) {
  const auto parameters = file_.parameters(number);
  if (!parameters) return std::unexpected(parameters.error());
  const auto head = numbers(file_, number, *parameters, 1, 2);  // kind of tuples, their number
  if (!head) return std::unexpected(head.error());
  const auto kind = static_cast<int>((*head)[0]);
  if (kind < 1 || kind > 3 || !((*head)[1] >= 2 && (*head)[1] < 1e8)) {
    return file_.error(number, "its points are of an unknown kind, or too few");
  }
  const auto count = static_cast<std::size_t>((*head)[1]);
  const std::size_t first = kind == 1 ? 4 : 3, size = kind == 1 ? 2 : kind == 2 ? 3 : 6;
  const auto v = numbers(file_, number, *parameters, first, size * count);
  const auto z = numbers(file_, number, *parameters, 3, 1);
  if (!v || !z) return std::unexpected(!v ? v.error() : z.error());
  auto corners = std::make_shared<std::vector<Point>>();
  for (std::size_t k = 0; k < count; ++k) {
    const double* p = &(*v)[size * k];
    corners->push_back(move * Point(p[0], p[1], kind == 1 ? (*z)[0] : p[2]));
  }
  Piece piece;
  points_ += count;
  piece.geometry = brep::polyline_of(*corners);
  for (std::size_t k = 1; k + 1 < count; ++k)
    piece.corners.push_back(static_cast<double>(k) / static_cast<double>(count - 1));
  piece.at = [corners](double t) { return along(*corners, t); };
  return piece;
}

Expected<Piece> CurveReader::spline(int number, const Eigen::Affine3d& outer) {
  auto read = read_curve(file_, number, outer);
  if (!read) return std::unexpected(std::move(read.error()));
  const auto curve = std::make_shared<const Curve>(*std::move(read));
  const auto parameters = file_.parameters(number);
  const std::size_t end = 7 + static_cast<std::size_t>(curve->size() + curve->knots(0).degree() +
                                                       1 + 4 * curve->size());
  Interval domain = curve->knots(0).domain();
  if (const auto limits = numbers(file_, number, *parameters, end, 2)) {
    const Interval range{std::max((*limits)[0], domain.lower),
                         std::min((*limits)[1], domain.upper)};
    if (range.length() > 0) domain = range;
  }
  Piece piece;
  points_ += static_cast<std::size_t>(curve->size());
  piece.set(curve, domain);
  const KnotVector& knots = curve->knots(0);
  for (const int s : knots.spans()) {
    if (knots[s] > domain.lower && knots.multiplicity(knots[s]) >= knots.degree())
      piece.corners.push_back((knots[s] - domain.lower) / domain.length());
  }
  return piece;
}

}  // namespace knead::iges
