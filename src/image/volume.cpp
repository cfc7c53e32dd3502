#include "knead/image/volume.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lines.hpp"

namespace knead {
namespace {

/// The voxels as `outer` blocks of `count` layers of `inner` numbers across one axis.
struct Across {
  std::size_t outer = 1, inner = 1;
  int count = 0;

  Across(const VolumeImage& volume, std::size_t axis) : count(volume.size[axis]) {
    for (std::size_t d = 0; d < 3; ++d) {
      if (d < axis) inner *= static_cast<std::size_t>(volume.size[d]);
      if (d > axis) outer *= static_cast<std::size_t>(volume.size[d]);
    }
  }
  [[nodiscard]] std::size_t at(std::size_t block, int layer) const {
    return (block * static_cast<std::size_t>(count) + static_cast<std::size_t>(layer)) * inner;
  }
};

/// Filtered along one axis by an odd number of weights, the border repeated.
void convolve(VolumeImage& volume, std::size_t axis, const std::vector<double>& weights) {
  const Across lines(volume, axis);
  const int reach = static_cast<int>(weights.size() / 2);
  std::vector<double> sums(static_cast<std::size_t>(lines.count) * lines.inner);
  for (std::size_t block = 0; block < lines.outer; ++block) {
    std::ranges::fill(sums, 0.0);
    for (int i = 0; i < lines.count; ++i) {
      double* to = sums.data() + static_cast<std::size_t>(i) * lines.inner;
      for (int k = -reach; k <= reach; ++k) {
        const double w = weights[static_cast<std::size_t>(k + reach)];
        const double* from =
            volume.values.data() + lines.at(block, std::clamp(i + k, 0, lines.count - 1));
        for (std::size_t c = 0; c < lines.inner; ++c) to[c] += w * from[c];
      }
    }
    std::ranges::copy(sums,
                      volume.values.begin() + static_cast<std::ptrdiff_t>(lines.at(block, 0)));
  }
}

/// What is done with every line of an axis: `work(first, stride, count)`.
template <class Work>
void each_line(VolumeImage& volume, std::size_t axis, const Work& work) {
  const Across lines(volume, axis);
  for (std::size_t block = 0; block < lines.outer; ++block) {
    for (std::size_t c = 0; c < lines.inner; ++c) {
      work(volume.values.data() + lines.at(block, 0) + c, lines.inner, lines.count);
    }
  }
}

/// Derivatives by voxels of the splines along an axis.
///
/// The derivative of the cubic spline at its knots, (c_{i+1} − c_{i−1})/2: of fourth order, where
/// differences of voxels are of second, at the cost of one filter.
VolumeImage slope_along(VolumeImage volume, std::size_t axis) {
  std::vector<double> line;
  each_line(volume, axis, [&line](double* first, std::size_t stride, int n) {
    if (n == 1) {
      *first = 0;
      return;
    }
    detail::interpolate_line(first, stride, n);
    line.clear();
    for (int i = 0; i < n; ++i) line.push_back(first[static_cast<std::size_t>(i) * stride]);
    first[0] = first[static_cast<std::size_t>(n - 1) * stride] = 0;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
      first[i * stride] = (line[i + 1] - line[i - 1]) / 2;
  });
  return volume;
}

}  // namespace

bool VolumeFrame::orthogonal() const {
  const Eigen::Vector3d s = spacing();
  const Eigen::Matrix3d g = directions.transpose() * directions;
  return std::abs(g(0, 1)) <= 1e-6 * s[0] * s[1] && std::abs(g(0, 2)) <= 1e-6 * s[0] * s[2] &&
         std::abs(g(1, 2)) <= 1e-6 * s[1] * s[2];
}

Expected<void> check_volume(const VolumeImage& volume) {
  const auto [nx, ny, nz] = volume.size;
  if (nx < 1 || ny < 1 || nz < 1) {
    return input_error(fmt::format("{} x {} x {} voxels are no volume", nx, ny, nz), "volume");
  }
  if (static_cast<double>(volume.values.size()) != double(nx) * ny * nz) {
    return input_error(
        fmt::format("{} x {} x {} voxels have {} values", nx, ny, nz, volume.values.size()),
        "volume", "give one per voxel");
  }
  for (std::size_t k = 0; k < volume.values.size(); ++k) {
    if (!std::isfinite(volume.values[k])) {
      return input_error("the value is not finite", fmt::format("voxel {}", k),
                         "replace it by a number");
    }
  }
  const VolumeFrame& frame = volume.frame;
  if (!frame.origin.allFinite() || !frame.directions.allFinite()) {
    return input_error("the place of the voxels is not finite", "space directions");
  }
  const double box = frame.spacing().prod();
  if (!(box > 0) || std::abs(frame.directions.determinant()) < 1e-9 * box) {
    return input_error("the steps between voxels lie in a plane", "space directions",
                       "give three independent ones");
  }
  return {};
}

VolumeImage gaussian(const VolumeImage& volume, double sigma) {
  VolumeImage result = volume;
  if (!(sigma > 0)) return result;
  const Eigen::Vector3d spacing = volume.frame.spacing();
  for (std::size_t d = 0; d < 3; ++d) {
    convolve(result, d, detail::gaussian_weights(sigma / spacing[static_cast<Eigen::Index>(d)]));
  }
  return result;
}

// x = origin + D i, hence ∂I/∂x = D⁻ᵀ ∂I/∂i.
std::array<VolumeImage, 3> gradient(const VolumeImage& volume) {
  std::array<VolumeImage, 3> slopes = {slope_along(volume, 0), slope_along(volume, 1),
                                       slope_along(volume, 2)};
  const Eigen::Matrix3d to_space = volume.frame.directions.inverse().transpose();
  for (std::size_t k = 0; k < volume.values.size(); ++k) {
    const Eigen::Vector3d g =
        to_space * Eigen::Vector3d(slopes[0].values[k], slopes[1].values[k], slopes[2].values[k]);
    for (std::size_t d = 0; d < 3; ++d) slopes[d].values[k] = g[static_cast<Eigen::Index>(d)];
  }
  return slopes;
}

VolumeImage gradient_magnitude(const VolumeImage& volume) {
  std::array<VolumeImage, 3> g = gradient(volume);
  for (std::size_t k = 0; k < volume.values.size(); ++k) {
    g[0].values[k] = std::hypot(g[0].values[k], g[1].values[k], g[2].values[k]);
  }
  return std::move(g[0]);
}

// One pass of lower envelopes along each axis, with the axis' own spacing. Squared distances along
// axes add up where these are perpendicular.
VolumeImage distance_to(const VolumeImage& mask) {
  VolumeImage result = mask;
  for (double& x : result.values) x = x >= 0.5 ? 0 : std::numeric_limits<double>::infinity();
  const Eigen::Vector3d spacing = mask.frame.spacing();
  std::vector<double> line, squared;
  for (std::size_t d = 0; d < 3; ++d) {
    const double step = spacing[static_cast<Eigen::Index>(d)];
    each_line(result, d, [&](double* first, std::size_t stride, int n) {
      line.clear();
      for (int i = 0; i < n; ++i) line.push_back(first[static_cast<std::size_t>(i) * stride]);
      detail::lower_envelope(line, squared, step);
      for (int i = 0; i < n; ++i)
        first[static_cast<std::size_t>(i) * stride] = squared[static_cast<std::size_t>(i)];
    });
  }
  for (double& x : result.values) x = std::sqrt(x);
  return result;
}

VolumeImage termination(const VolumeImage& volume) {
  const std::array<VolumeImage, 3> g = gradient(volume);
  const std::array<VolumeImage, 3> hx = gradient(g[0]), hy = gradient(g[1]), hz = gradient(g[2]);
  VolumeImage result = volume;
  double largest = 0;
  const auto at = [](const std::array<VolumeImage, 3>& v, std::size_t k) {
    return Eigen::Vector3d(v[0].values[k], v[1].values[k], v[2].values[k]);
  };
  for (std::size_t k = 0; k < volume.values.size(); ++k)
    largest = std::max(largest, at(g, k).norm());
  for (std::size_t k = 0; k < volume.values.size(); ++k) {
    const Eigen::Vector3d slope = at(g, k);
    const double s = slope.norm();
    Eigen::Matrix3d h;
    h << at(hx, k), at(hy, k), at(hz, k);
    result.values[k] =
        s > 1e-3 * largest ? (s * s * h.trace() - slope.dot(h * slope)) / (s * s * s) : 0;
  }
  return result;
}

std::array<VolumeImage, 3> gradient_vector_flow(const VolumeImage& edges, double mu,
                                                int iterations) {
  VolumeImage scaled = edges;
  const Eigen::Vector3d spacing = edges.frame.spacing();
  const double shortest = spacing.minCoeff();
  scaled.frame.directions /= shortest;
  const auto [low, high] = std::ranges::minmax_element(edges.values);
  const double base = *low, range = *high - *low;
  for (double& x : scaled.values) x = range > 0 ? (x - base) / range : 0;
  const std::array<VolumeImage, 3> slope = gradient(scaled);
  VolumeImage steep = edges;  // |∇f|²
  for (std::size_t k = 0; k < steep.values.size(); ++k) {
    const double x = slope[0].values[k], y = slope[1].values[k], z = slope[2].values[k];
    steep.values[k] = x * x + y * y + z * z;
  }
  const Eigen::Vector3d share = mu * (shortest / spacing.array()).square();
  // Stable: no weight of a voxel itself is negative.
  const double step =
      1 / (2 * share.sum() + std::max(1.0, *std::ranges::max_element(steep.values)));
  std::array<VolumeImage, 3> flow = slope;
  const auto [nx, ny, nz] = edges.size;
  for (std::size_t d = 0; d < 3; ++d) {
    VolumeImage next = flow[d];
    for (int i = 0; i < iterations; ++i) {
      const VolumeImage& f = flow[d];
      for (int z = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
          const auto line = [&f](int j, int k) { return f.values.data() + f.index(0, j, k); };
          const double *row = line(y, z), *before = line(std::max(y - 1, 0), z),
                       *after = line(std::min(y + 1, ny - 1), z),
                       *below = line(y, std::max(z - 1, 0)),
                       *above = line(y, std::min(z + 1, nz - 1));
          const std::size_t start = f.index(0, y, z);
          for (int x = 0; x < nx; ++x) {
            const double here = row[x], twice = 2 * here;
            const double spread =
                share[0] * (row[std::max(x - 1, 0)] + row[std::min(x + 1, nx - 1)] - twice) +
                share[1] * (before[x] + after[x] - twice) +
                share[2] * (below[x] + above[x] - twice);
            const std::size_t k = start + static_cast<std::size_t>(x);
            next.values[k] = here + step * (spread - steep.values[k] * (here - slope[d].values[k]));
          }
        }
      }
      std::swap(flow[d].values, next.values);
    }
  }
  return flow;
}

// As `ImageSpline`, with one direction more.
VolumeSpline::VolumeSpline(const VolumeImage& volume) : size_(volume.size) {
  VolumeImage c = volume;
  for (std::size_t d = 0; d < 3; ++d) each_line(c, d, detail::interpolate_line);
  const auto mirrored = [](int k, int n) {
    return n == 1 ? 0 : k < 0 ? -k : k >= n ? 2 * n - 2 - k : k;
  };
  std::size_t all = 1;
  for (const int n : size_) all *= static_cast<std::size_t>(n + 2);
  coefficients_.reserve(all);
  for (int z = -1; z <= size_[2]; ++z) {
    for (int y = -1; y <= size_[1]; ++y) {
      for (int x = -1; x <= size_[0]; ++x) {
        coefficients_.push_back(
            c.at(mirrored(x, size_[0]), mirrored(y, size_[1]), mirrored(z, size_[2])));
      }
    }
  }
}

// 64 coefficients once for the value and all three derivatives: sums along x serve both y and z.
Eigen::Vector4d VolumeSpline::sum(const Point& voxel, bool derivatives) const {
  double values[3][4], slopes[3][4];
  int first[3], used[3];
  for (Eigen::Index d = 0; d < 3; ++d) {
    const int n = size_[static_cast<std::size_t>(d)];
    const double u = std::clamp(voxel[d], 0.0, n - 1.0);
    first[d] = std::clamp(static_cast<int>(u), 0, std::max(n - 2, 0));
    used[d] = std::min(4, n + 2 - first[d]);  // of a volume of one layer
    detail::cubic_basis(u - first[d], values[d], false);
    if (derivatives) detail::cubic_basis(u - first[d], slopes[d], true);
  }
  const auto row = static_cast<std::size_t>(size_[0] + 2),
             layer = row * static_cast<std::size_t>(size_[1] + 2);
  Eigen::Vector4d total = Eigen::Vector4d::Zero();
  for (int c = 0; c < used[2]; ++c) {
    double plain = 0, along_x = 0, along_y = 0;
    for (int b = 0; b < used[1]; ++b) {
      const double* line = coefficients_.data() + static_cast<std::size_t>(first[2] + c) * layer +
                           static_cast<std::size_t>(first[1] + b) * row +
                           static_cast<std::size_t>(first[0]);
      double sum = 0, slope = 0;
      for (int a = 0; a < used[0]; ++a) sum += values[0][a] * line[a];
      plain += values[1][b] * sum;
      if (!derivatives) continue;
      for (int a = 0; a < used[0]; ++a) slope += slopes[0][a] * line[a];
      along_x += values[1][b] * slope;
      along_y += slopes[1][b] * sum;
    }
    total[0] += values[2][c] * plain;
    if (!derivatives) continue;
    total[1] += values[2][c] * along_x;
    total[2] += values[2][c] * along_y;
    total[3] += slopes[2][c] * plain;
  }
  return total;
}

double VolumeSpline::value(const Point& voxel) const { return sum(voxel, false)[0]; }

Eigen::Vector3d VolumeSpline::gradient(const Point& voxel) const {
  Eigen::Vector3d g = sum(voxel, true).tail<3>();
  for (Eigen::Index d = 0; d < 3; ++d) {
    if (voxel[d] < 0 || voxel[d] > size_[static_cast<std::size_t>(d)] - 1.0) g[d] = 0;
  }
  return g;
}

}  // namespace knead
