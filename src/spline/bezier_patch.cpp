#include "bezier_patch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead::detail {
namespace {

using Net = BezierPatch::Net;
using Vector4 = Eigen::Vector4d;

/// Control points first, first + stride, …, of degree p, restricted to the part of [0, 1] left
/// (right) of t.
/// De Casteljau's algorithm in place. Each step is a convex combination for t in [0, 1]: nothing
/// cancels, and what a net encloses its part encloses too.
void keep_left(Vector4* first, int p, int stride, double t) {
  for (int r = 1; r <= p; ++r) {
    for (int i = p; i >= r; --i)
      first[i * stride] = (1 - t) * first[(i - 1) * stride] + t * first[i * stride];
  }
}
void keep_right(Vector4* first, int p, int stride, double t) {
  for (int r = 1; r <= p; ++r) {
    for (int i = 0; i <= p - r; ++i)
      first[i * stride] = (1 - t) * first[i * stride] + t * first[(i + 1) * stride];
  }
}
void restrict_to(const Range& side, Vector4* first, int p, int stride) {
  if (side.upper < 1) keep_left(first, p, stride, side.upper);
  // The net is that of [0, upper] by then: lower has moved to lower / upper.
  if (side.lower > 0) keep_right(first, p, stride, side.upper > 0 ? side.lower / side.upper : 0);
}

struct Hull {
  Vector4 lower = Vector4::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  void include(const Vector4& x) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  [[nodiscard]] Range operator[](std::size_t k) const {
    return {lower[static_cast<Eigen::Index>(k)], upper[static_cast<Eigen::Index>(k)]};
  }
};

/// The hull of ∂^a of a Bézier net over a rectangle with sides of these lengths; zero if a length
/// is zero.
/// A derivative is a Bézier form again, whose points are p / length times differences of the net:
/// their box encloses it.
Hull derivative_hull(const Net& net, int p, int q, int a, int b, double length_u, double length_v) {
  Hull hull;
  if (a > p || b > q || (a > 0 && length_u == 0) || (b > 0 && length_v == 0)) {
    hull.include(Vector4::Zero());
    return hull;
  }
  double factor = 1;
  for (int k = 0; k < a; ++k) factor *= (p - k) / length_u;
  for (int k = 0; k < b; ++k) factor *= (q - k) / length_v;
  const auto at = [&](int i, int j) -> const Vector4& { return net[index(i * (q + 1) + j)]; };
  for (int i = 0; i + a <= p; ++i) {
    for (int j = 0; j + b <= q; ++j) {
      Vector4 d;
      if (a == 1 && b == 1) {
        d = (at(i + 1, j + 1) - at(i + 1, j)) - (at(i, j + 1) - at(i, j));
      } else if (a == 1) {
        d = at(i + 1, j) - at(i, j);
      } else if (b == 1) {
        d = at(i, j + 1) - at(i, j);
      } else if (a == 2) {
        d = (at(i + 2, j) - at(i + 1, j)) - (at(i + 1, j) - at(i, j));
      } else if (b == 2) {
        d = (at(i, j + 2) - at(i, j + 1)) - (at(i, j + 1) - at(i, j));
      } else {
        d = at(i, j);
      }
      hull.include(factor * d);
    }
  }
  return hull;
}

constexpr std::array<std::array<int, 2>, 6> jet_orders = {
    {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};

/// Bernstein polynomials of degree p and their first two derivatives: out[d][i].
/// B_i' = p (B_{i−1} − B_i) with polynomials of degree p − 1, so derivatives are differences of
/// values met on the way up to degree p.
void bernstein(int p, double t, std::array<std::array<double, max_degree + 1>, 3>& out) {
  std::array<double, max_degree + 1> b{};
  b[0] = 1;
  const auto take = [&](int degree,
                        std::size_t order) {  // differences of the values of lower degree
    std::array<double, max_degree + 1> d = b;
    int have = degree;
    for (std::size_t k = 0; k < order; ++k) {
      ++have;
      for (int i = have; i >= 0; --i) {
        d[index(i)] = have * ((i > 0 ? d[index(i - 1)] : 0) - (i < have ? d[index(i)] : 0));
      }
    }
    out[order] = d;
  };
  out[1].fill(0);
  out[2].fill(0);
  for (int degree = 0; degree <= p; ++degree) {
    if (degree > 0) {
      for (int i = degree; i >= 0; --i) {
        b[index(i)] = (i < degree ? (1 - t) * b[index(i)] : 0) + (i > 0 ? t * b[index(i - 1)] : 0);
      }
    }
    if (degree == p - 2) take(degree, 2);
    if (degree == p - 1) take(degree, 1);
    if (degree == p) take(degree, 0);
  }
}

/// The Bézier points of one span of one row by blossoming: b_j = f(a, …, a, b, …, b) with j
/// arguments b.
void extract(const KnotVector& knots, int span, std::vector<Vector4>& row) {
  const int p = knots.degree();
  const double a = knots[span], b = knots[span + 1];
  std::vector<Vector4> bezier(row.size()), d;
  for (int j = 0; j <= p; ++j) {
    d = row;
    for (int r = 1; r <= p; ++r) {
      const double t = r <= p - j ? a : b;
      for (int i = p; i >= r; --i) {
        const double left = knots[span - p + i], right = knots[span + 1 + i - r];
        const double alpha = (t - left) / (right - left);
        d[index(i)] = (1 - alpha) * d[index(i - 1)] + alpha * d[index(i)];
      }
    }
    bezier[index(j)] = d[index(p)];
  }
  row = bezier;
}

/// Divides rational points by the largest weight. Error: a weight that is not positive.
Expected<void> normalise(Net& net, bool rational, const std::string& where) {
  double largest = 0;
  for (const Vector4& point : net) largest = std::max(largest, point.w());
  for (Vector4& point : net) {
    if (!(point.w() > 0)) {
      return input_error(fmt::format("{} is a Bézier weight", point.w()), where,
                         "use a surface with positive weights");
    }
    if (rational) point /= largest;
  }
  return {};
}

}  // namespace

// Boxes of position and derivatives over a rectangle. Rational patches: A = w S, thus S_u = (A_u −
// w_u S) / w and so on (Piegl & Tiller, The NURBS Book, 4.5), with intervals for every term.
// Intervals forget that A and w belong together; about the centre of the patch S is small, and with
// it all that they forget.
PatchBounds BezierPatch::bounds(const ParameterRectangle& at) const {
  Net net = net_;
  for (int j = 0; j <= q_; ++j) restrict_to(at.side[0], &net[index(j)], p_, q_ + 1);
  for (int i = 0; i <= p_; ++i) restrict_to(at.side[1], &net[index(i * (q_ + 1))], q_, 1);
  const double lu = at.side[0].upper - at.side[0].lower, lv = at.side[1].upper - at.side[1].lower;
  PatchBounds b;
  if (!rational_) {
    for (std::size_t k = 0; k < 6; ++k) {
      const Hull h = derivative_hull(net, p_, q_, jet_orders[k][0], jet_orders[k][1], lu, lv);
      for (std::size_t c = 0; c < 3; ++c) b[k].axis[c] = h[c];
    }
    b[6] = b[1];
    b[7] = b[2];
    return b;
  }
  // Quotients about the centre of the hull, so that the terms with S are small.
  Hull cartesian;
  double w_low = net[0].w(), w_high = w_low;
  for (const Vector4& point : net) {
    cartesian.include(point / point.w());
    w_low = std::min(w_low, point.w());
    w_high = std::max(w_high, point.w());
  }
  const Vector4 middle(0.5 * (cartesian.lower.x() + cartesian.upper.x()),
                       0.5 * (cartesian.lower.y() + cartesian.upper.y()),
                       0.5 * (cartesian.lower.z() + cartesian.upper.z()), 0);
  // A − w m: in homogeneous points the shift by m. Derivatives of S do not change.
  for (Vector4& point : net) point -= point.w() * middle;
  std::array<Hull, 6> h;
  for (std::size_t k = 1; k < 6; ++k)
    h[k] = derivative_hull(net, p_, q_, jet_orders[k][0], jet_orders[k][1], lu, lv);
  const Range w = {w_low, w_high};
  for (std::size_t c = 0; c < 3; ++c) {
    b[0].axis[c] = cartesian[c];
    const Range s = cartesian[c] + -middle[static_cast<Eigen::Index>(c)];
    const Range u = (h[1][c] - h[1][3] * s) / w, v = (h[2][c] - h[2][3] * s) / w;
    b[1].axis[c] = u;
    b[2].axis[c] = v;
    b[3].axis[c] = (h[3][c] - 2 * (h[1][3] * u) - h[3][3] * s) / w;
    b[4].axis[c] = (h[4][c] - h[1][3] * v - h[2][3] * u - h[4][3] * s) / w;
    b[5].axis[c] = (h[5][c] - 2 * (h[2][3] * v) - h[5][3] * s) / w;
  }
  b[6] = b[1];
  b[7] = b[2];
  return b;
}

PatchJet BezierPatch::jet(double u, double v) const {
  std::array<std::array<double, max_degree + 1>, 3> nu, nv;
  bernstein(p_, u, nu);
  bernstein(q_, v, nv);
  std::array<Vector4, 6> h;
  h.fill(Vector4::Zero());
  for (int i = 0; i <= p_; ++i) {
    std::array<Vector4, 3> row = {Vector4::Zero(), Vector4::Zero(), Vector4::Zero()};
    for (int j = 0; j <= q_; ++j) {
      const Vector4& point = net_[index(i * (q_ + 1) + j)];
      for (std::size_t d = 0; d < 3; ++d) row[d] += nv[d][index(j)] * point;
    }
    for (std::size_t k = 0; k < 6; ++k)
      h[k] += nu[index(jet_orders[k][0])][index(i)] * row[index(jet_orders[k][1])];
  }
  PatchJet j;
  if (!rational_) {
    for (std::size_t k = 0; k < 6; ++k) j[k] = h[k].head<3>();
    return j;
  }
  const double w = h[0].w();
  j[0] = h[0].head<3>() / w;
  for (std::size_t k = 1; k < 3; ++k) j[k] = (h[k].head<3>() - h[k].w() * j[0]) / w;
  j[3] = (h[3].head<3>() - 2 * h[1].w() * j[1] - h[3].w() * j[0]) / w;
  j[4] = (h[4].head<3>() - h[1].w() * j[2] - h[2].w() * j[1] - h[4].w() * j[0]) / w;
  j[5] = (h[5].head<3>() - 2 * h[2].w() * j[2] - h[5].w() * j[0]) / w;
  return j;
}

Expected<std::vector<std::unique_ptr<Patch>>> bezier_patches(const Surface& surface,
                                                             const Point& scale) {
  const KnotVector &ku = surface.knots(0), &kv = surface.knots(1);
  const int p = ku.degree(), q = kv.degree(), n = kv.count();
  std::vector<std::unique_ptr<Patch>> patches;
  std::vector<Vector4> column(index(p + 1)), row(index(q + 1));
  for (int su : ku.spans()) {
    for (int sv : kv.spans()) {
      Net net(index((p + 1) * (q + 1)));
      for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
          const int from = (su - p + i) * n + sv - q + j;
          const double w = surface.rational() ? surface.weights()[index(from)] : 1;
          row[index(j)] << w * surface.control_points().row(from).transpose().cwiseProduct(scale),
              w;
        }
        extract(kv, sv, row);
        std::copy(row.begin(), row.end(), net.begin() + i * (q + 1));
      }
      for (int j = 0; j <= q; ++j) {
        for (int i = 0; i <= p; ++i) column[index(i)] = net[index(i * (q + 1) + j)];
        extract(ku, su, column);
        for (int i = 0; i <= p; ++i) net[index(i * (q + 1) + j)] = column[index(i)];
      }
      if (auto status =
              normalise(net, surface.rational(), fmt::format("surface: span ({}, {})", su, sv));
          !status) {
        return std::unexpected(status.error());
      }
      patches.push_back(std::make_unique<BezierPatch>(p, q, std::move(net), surface.rational()));
    }
  }
  return patches;
}

Expected<std::vector<std::unique_ptr<Patch>>> bezier_patches(const Curve& curve) {
  const KnotVector& knots = curve.knots(0);
  const int p = knots.degree();
  std::vector<std::unique_ptr<Patch>> patches;
  for (const int span : knots.spans()) {
    Net net(index(p + 1));
    for (int i = 0; i <= p; ++i) {
      const int from = span - p + i;
      const double w = curve.rational() ? curve.weights()[index(from)] : 1;
      net[index(i)] << w * curve.control_points().row(from).transpose(), w;
    }
    extract(knots, span, net);
    if (auto status = normalise(net, curve.rational(), fmt::format("curve: span {}", span));
        !status) {
      return std::unexpected(status.error());
    }
    patches.push_back(std::make_unique<BezierPatch>(p, 0, std::move(net), curve.rational()));
  }
  return patches;
}

}  // namespace knead::detail
