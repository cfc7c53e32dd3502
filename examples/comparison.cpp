#include "comparison.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

#include "knead/contact/active_spline.hpp"
#include "knead/energy/loads.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "mass_spring.hpp"

namespace knead::examples {
namespace {

constexpr double alpha = 1, beta = 0.01, pi = std::numbers::pi;
constexpr int fine = 201;  // places per direction at which errors are measured

double answer(double u, double v) { return std::sin(pi * u) * std::sin(pi * v); }
constexpr double load_factor = 2 * alpha * pi * pi + 4 * beta * pi * pi * pi * pi;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Heights of control points on equidistant places.
Eigen::MatrixXd sampled(const KnotVector& knots, const Eigen::MatrixXd& control_points,
                        int count = fine) {
  const Eigen::MatrixXd b = basis_matrix(knots, equidistant(count));
  return b * control_points * b.transpose();
}

double largest_error(const KnotVector& knots, const Eigen::MatrixXd& control_points) {
  const Eigen::MatrixXd s = sampled(knots, control_points);
  const std::vector<double> at = equidistant(fine);
  double largest = 0;
  for (int i = 0; i < fine; ++i) {
    for (int j = 0; j < fine; ++j) {
      const double w = answer(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]);
      largest = std::max(largest, std::abs(s(i, j) - w));
    }
  }
  return largest;
}

/// The heights of all masses from those of the inner ones.
Eigen::MatrixXd with_border(const Eigen::VectorXd& inner, int n) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n - 2; ++i) {
    for (int j = 0; j < n - 2; ++j) all(i + 1, j + 1) = inner[i * (n - 2) + j];
  }
  return all;
}

Expected<Surface> flat_sheet(const KnotVector& knots) {
  const int n = knots.count();
  Points points = Points::Zero(n * n, 3);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) points.row(i * n + j) << knots.greville(i), knots.greville(j), 0;
  }
  return Surface::create({knots, knots}, std::move(points));
}

ActiveSettings<2> hinged(int n) {
  ActiveSettings<2> settings;
  settings.material = {{alpha, 0, alpha}, {beta, beta, beta}};
  settings.raw = true;
  settings.evolution = Evolution::stationary;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      settings.held.push_back(i == 0 || j == 0 || i == n - 1 || j == n - 1);
  }
  return settings;
}

}  // namespace

Expected<Comparison> compare_models(int n) {
  const auto knots = KnotVector::clamped_uniform(3, n);
  if (!knots) return std::unexpected(knots.error());
  Comparison result;

  const double h = 1.0 / (n - 1);
  Eigen::VectorXd f((n - 2) * (n - 2));
  Eigen::VectorXd exact = f;
  for (int i = 0; i < n - 2; ++i) {
    for (int j = 0; j < n - 2; ++j) {
      exact[i * (n - 2) + j] = answer((i + 1) * h, (j + 1) * h);
      f[i * (n - 2) + j] = h * h * load_factor * exact[i * (n - 2) + j];
    }
  }
  double start = now();
  const SparseMatrix k = spring_sheet(n, alpha, beta / (h * h));
  const auto factor = SparseCholesky::factor(k);
  if (!factor) return std::unexpected(factor.error());
  const Eigen::VectorXd x = factor->solve(f);
  result.direct_time = now() - start;
  result.spring_error = (x - exact).cwiseAbs().maxCoeff();
  start = now();
  result.relax_steps =
      relax(k, f, h * h * load_factor, 1e-8).steps;  // masses of 1: ω² is that of h² K
  result.relax_time = now() - start;
  const auto averaged = averaged_knots(equidistant(n));
  if (!averaged) return std::unexpected(averaged.error());
  const GlobalInterpolation interpolation(*averaged, equidistant(n));
  start = now();
  const Eigen::MatrixXd control_points = interpolation.control_points(with_border(x, n));
  result.interpolation_time = now() - start;
  result.surface_error = largest_error(*averaged, control_points);

  const auto sheet = flat_sheet(*knots);
  if (!sheet) return std::unexpected(sheet.error());
  ActiveLoads loads;
  const LoadFunction<2> load = [](const std::array<double, 2>& u) {
    return Point(0, 0, load_factor * answer(u[0], u[1]));
  };
  auto nodal = load_forces<2>(*sheet, DomainScaling<2>{}, load, 8);
  if (!nodal) return std::unexpected(nodal.error());
  loads.nodal = std::move(*nodal);
  start = now();
  const auto model = ActiveSurface::create(*sheet, hinged(n));
  if (!model) return std::unexpected(model.error());
  result.exact_setup = now() - start;
  start = now();
  const auto step = model->step(ActiveState{sheet->control_points()}, {}, loads);
  if (!step) return std::unexpected(step.error());
  result.exact_step = now() - start;
  const Eigen::MatrixXd heights = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      Eigen::VectorXd(step->control_points.col(2)).data(), n, n);
  result.exact_error = largest_error(*knots, heights);
  return result;
}

Expected<Touch> touch(int n, double spring) {
  const double h = 1.0 / (n - 1);
  SparseMatrix k = spring_sheet(n, alpha, beta / (h * h));
  const Eigen::VectorXd pull = Eigen::VectorXd::Constant(k.rows(), spring);
  SparseMatrix identity(k.rows(), k.rows());
  identity.setIdentity();
  k += spring * identity;
  const auto factor = SparseCholesky::factor(k);
  if (!factor) return std::unexpected(factor.error());
  const auto knots = KnotVector::clamped_uniform(3, n);
  if (!knots) return std::unexpected(knots.error());
  Touch result;
  result.springs = with_border(factor->solve(pull), n)((n - 1) / 2, (n - 1) / 2);

  Energy<2> energy = stretch_and_bend({{alpha, 0, alpha}, {beta, beta, beta}});
  const Energy<2> mass = mass_energy<2>(spring);
  energy.insert(energy.end(), mass.begin(), mass.end());
  const auto whole = Stiffness<2>::create({*knots, *knots}, energy);
  const auto forces = Stiffness<2>::create({*knots, *knots}, mass);
  if (!whole || !forces) return std::unexpected((whole ? forces : whole).error());
  const Points load = forces->apply(Points::Ones(n * n, 3));
  const SparseMatrix all = whole->assemble();
  std::vector<Eigen::Triplet<double>> entries;
  const auto inner = [n](Eigen::Index at) {
    const int i = static_cast<int>(at) / n, j = static_cast<int>(at) % n;
    return i == 0 || j == 0 || i == n - 1 || j == n - 1 ? -1 : (i - 1) * (n - 2) + j - 1;
  };
  Eigen::VectorXd f((n - 2) * (n - 2));
  for (int column = 0; column < n * n; ++column) {
    if (inner(column) < 0) continue;
    f[inner(column)] = load(column, 2);
    for (SparseMatrix::InnerIterator it(all, column); it; ++it) {
      if (inner(it.row()) >= 0) entries.emplace_back(inner(it.row()), inner(column), it.value());
    }
  }
  SparseMatrix reduced(f.size(), f.size());
  reduced.setFromTriplets(entries.begin(), entries.end());
  const auto solver = SparseCholesky::factor(reduced);
  if (!solver) return std::unexpected(solver.error());
  result.exact = sampled(*knots, with_border(solver->solve(f), n), 3)(1, 1);
  return result;
}

Expected<double> interpolation_drift(double cluster, int rounds) {
  constexpr int n = 32;
  const auto uniform = KnotVector::clamped_uniform(3, n);
  if (!uniform) return std::unexpected(uniform.error());
  std::vector<double> list(uniform->knots().begin(), uniform->knots().end());
  if (cluster > 0) {
    list[17] = list[16] + cluster;
    list[18] = list[16] + 2 * cluster;
  }
  const auto knots = KnotVector::create(3, list);
  if (!knots) return std::unexpected(knots.error());
  std::vector<double> abscissae;
  for (int i = 0; i < n; ++i) abscissae.push_back(knots->greville(i));
  const GlobalInterpolation interpolation(*knots, abscissae);
  Eigen::MatrixXd first(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      first(i, j) = answer(abscissae[static_cast<std::size_t>(i)], 0.3 * j) + 0.1 * ((i * j) % 3);
  }
  Eigen::MatrixXd control_points = first;
  for (int k = 0; k < rounds; ++k)
    control_points = interpolation.control_points(interpolation.heights(control_points));
  return (control_points - first).cwiseAbs().maxCoeff() / first.cwiseAbs().maxCoeff();
}

Expected<double> ripple(int n, double distance, bool averaged) {
  constexpr double radius = 0.25;
  const auto knots = averaged ? averaged_knots(equidistant(n)) : KnotVector::clamped_uniform(3, n);
  if (!knots) return std::unexpected(knots.error());
  const auto dent = [](double u, double v) {
    const double r2 = (u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5);
    return std::max(0.0, 1 - r2 / (radius * radius));
  };
  const std::vector<double> at = equidistant(n), places = equidistant(fine);
  Eigen::MatrixXd heights(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      heights(i, j) = dent(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd s =
      sampled(*knots, GlobalInterpolation(*knots, at).control_points(heights));
  double largest = 0;
  for (int i = 0; i < fine; ++i) {
    for (int j = 0; j < fine; ++j) {
      const double u = places[static_cast<std::size_t>(i)], v = places[static_cast<std::size_t>(j)];
      if (std::hypot(u - 0.5, v - 0.5) > radius + distance)
        largest = std::max(largest, std::abs(s(i, j)));
    }
  }
  return largest;
}

Expected<double> movement_at_rest(int n) {
  const auto knots = KnotVector::clamped_uniform(3, n);
  if (!knots) return std::unexpected(knots.error());
  const auto sheet = flat_sheet(*knots);
  if (!sheet) return std::unexpected(sheet.error());
  Points points = sheet->control_points();
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    points(i, 2) = answer(points(i, 0), 3 * points(i, 1)) + 0.1 * (i % 3);
  const auto rest = sheet->with_control_points(points);
  if (!rest) return std::unexpected(rest.error());
  const auto model = ActiveSurface::create(*rest, hinged(n));
  if (!model) return std::unexpected(model.error());
  const auto step = model->step(points, {});
  if (!step) return std::unexpected(step.error());
  return (step->control_points - points).cwiseAbs().maxCoeff();
}

}  // namespace knead::examples
