#include "data_stretch.hpp"

#include <algorithm>
#include <array>

#include "base/decompositions.hpp"
#include "knead/spline/evaluate.hpp"
#include "morph/affine_part.hpp"

namespace knead::detail {
namespace {

constexpr double neighbourhood = 0.02;  // of the size
constexpr std::size_t least_data = 24;  // of each face
constexpr double least_extent = 0.3;    // of the largest
constexpr double difference = 1e-6;     // of the size

/// Data on one surface, in the coordinates of its part.
struct FaceData {
  Points places, displacements;
};

/// The surfaces under these faces.
std::vector<std::size_t> surfaces_of(const MovingModel& model, std::span<const std::string> faces) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    const auto is_of = [&](const std::string& face) {
      return std::ranges::find(model.faces[k], face) != model.faces[k].end() ||
             model.source->surfaces()[k].id == face;  // called so where no face is on it
    };
    if (std::ranges::any_of(faces, is_of)) result.push_back(k);
  }
  return result;
}

/// Empty: not enough is known.
Expected<FaceData> data_on(const MovingModel& model, std::span<const morph::Datum> data,
                           std::size_t surface) {
  std::vector<const morph::Datum*> found;
  for (const morph::Datum& datum : data) {
    if (datum.surface == static_cast<int>(surface) && datum.along.isZero(0) && datum.weight > 0)
      found.push_back(&datum);
  }
  if (found.size() < least_data) return FaceData{};
  const auto count = std::ssize(found);
  FaceData result{Points(count, 3), Points(count, 3)};
  Parameters<2> parameters(count, 2);
  const Eigen::Matrix3d to_part = model.places[surface].to_model.linear().inverse();
  for (Eigen::Index k = 0; k < count; ++k) {
    const morph::Datum& datum = *found[static_cast<std::size_t>(k)];
    parameters.row(k) << datum.parameters[0], datum.parameters[1];
    result.displacements.row(k) = (to_part * datum.displacement).transpose();
  }
  const auto values = evaluate<2>(*model.surfaces[surface].surface, parameters, 0);
  if (!values) return std::unexpected(values.error());
  result.places = values->points();
  return result;
}

/// What lies around a place: places and displacements from their means on each face.
struct Neighbours {
  Points places, displacements;
  std::vector<double> weights;
};

Neighbours neighbours_of(std::span<const FaceData> faces, const Point& at, double size) {
  double h = neighbourhood * size;
  std::vector<Eigen::VectorXd> distances;
  for (const FaceData& face : faces) {
    distances.emplace_back((face.places.rowwise() - at.transpose()).rowwise().norm());
    std::vector<double> sorted(distances.back().begin(), distances.back().end());
    std::ranges::nth_element(sorted, sorted.begin() + least_data - 1);
    h = std::max(h, sorted[least_data - 1]);
  }
  Neighbours result;
  Eigen::Index count = 0;
  for (const FaceData& face : faces) count += face.places.rows();
  result.places.resize(count, 3);
  result.displacements.resize(count, 3);
  Eigen::Index begin = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Eigen::Index rows = faces[f].places.rows();
    Eigen::VectorXd weights = (1 - (distances[f] / h).array().square()).cwiseMax(0).square();
    const double total = weights.sum();
    if (total > 0) weights /= total;
    result.weights.insert(result.weights.end(), weights.begin(), weights.end());
    const auto about_mean = [&](const Points& values) {
      const Eigen::RowVector3d mean = weights.transpose() * values;
      return (values.rowwise() - mean).eval();
    };
    result.places.middleRows(begin, rows) = about_mean(faces[f].places);
    result.displacements.middleRows(begin, rows) = about_mean(faces[f].displacements);
    begin += rows;
  }
  return result;
}

Expected<double> stretch_of(Neighbours data) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Eigen::Index k = 0; k < data.places.rows(); ++k) {
    const Point y = data.places.row(k).transpose();
    moments += data.weights[static_cast<std::size_t>(k)] * y * y.transpose();
  }
  const auto axes = symmetric_eigen(moments);
  if (!axes) return std::unexpected(axes.error());
  const double least = least_extent * least_extent * axes->values[2];
  const auto known = std::ranges::count_if(axes->values, [&](double m) { return m >= least; });
  if (!(axes->values[2] > 0)) return 1;
  const Eigen::Matrix3Xd directions = axes->vectors.rightCols(known);
  data.places = (data.places * directions * directions.transpose()).eval();
  const auto affine = morph::best_affine(data.places, data.displacements, data.weights);
  if (!affine) return std::unexpected(affine.error());
  const auto singular = left_singular(directions + affine->linear * directions);
  if (!singular) return std::unexpected(singular.error());
  return std::max(1.0, singular->values[0]);
}

/// By a map of space, at a place in the model.
Expected<double> stretch_by(const fields::SpaceMap& map, const Point& at, double size) {
  Eigen::Matrix3d linear;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<Point, 2> slopes;
    for (const int side : {0, 1}) {
      const Point step = (side == 0 ? -1 : 1) * difference * size * Point::Unit(axis);
      const auto near = map.at(at + step), far = map.at(at + 2 * step);
      if (!near) return std::unexpected(near.error());
      if (!far) return std::unexpected(far.error());
      slopes[static_cast<std::size_t>(side)] = (*far - *near) / step[axis];
    }
    linear.col(axis) = slopes[0].norm() < slopes[1].norm() ? slopes[0] : slopes[1];
  }
  const auto singular = left_singular(Eigen::Matrix3d::Identity() + linear);
  if (!singular) return std::unexpected(singular.error());
  return std::max(1.0, singular->values[0]);
}

}  // namespace

Expected<double> data_stretch(const MovingModel& model, const MorphPoints& data,
                              std::span<const std::string> faces, std::span<const Point> at,
                              double size) {
  const auto surfaces = surfaces_of(model, faces);
  if (surfaces.empty() ||
      std::ranges::any_of(surfaces, [&](std::size_t k) { return model.surfaces[k].fixed; }))
    return 1;
  std::vector<FaceData> found;
  for (const std::size_t k : surfaces) {
    if (data.map) break;
    auto on = data_on(model, data.found.data, k);
    if (!on) return std::unexpected(on.error());
    if (on->places.rows() == 0) return 1;
    found.push_back(*std::move(on));
  }
  double result = 1;
  for (const Point& place : at) {
    const auto stretch =
        data.map ? stretch_by(*data.map, model.places[surfaces[0]].to_model * place, size)
                 : stretch_of(neighbours_of(found, place, size));
    if (!stretch) return std::unexpected(stretch.error());
    result = std::max(result, *stretch);
  }
  return result;
}

}  // namespace knead::detail
