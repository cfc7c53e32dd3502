#include "knead/image/surface_snake.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/decompositions.hpp"
#include "knead/spline/evaluate.hpp"
#include "region_term.hpp"
#include "snake_motion.hpp"
#include "snake_settings.hpp"
#include "surface_net.hpp"

namespace knead {
namespace {

constexpr int band_layers = 4;
constexpr double most_uneven_area = 4, nearly_singular = 1e-6;

/// Σ over the voxels inside by the divergence theorem, in voxels; signed.
struct InsideSums {
  double volume = 0, intensity = 0;
};

/// Grey values on both sides.
struct Greys {
  double inside = 0, outside = 0;
};

/// One surface on its way.
struct MovingSurface {
  SurfaceSnakeSettings settings;
  SurfaceNet net;
  Points c;                   ///< its unknowns
  Eigen::MatrixXd held = {};  ///< the functions at each spring's point, one column each
  Eigen::MatrixXd spread = {};
  int iterations = 0;
  SnakeMotion motion = {};
  std::optional<SurfaceNet> mass = {}, poisson = {};  ///< solve with M, and with the stretch of α 1

  /// Everything that depends on the net and the viscosity.
  Expected<void> prepare() {
    if (auto status = net.factor(viscosity()); !status) return status;
    const auto count = std::ssize(settings.springs);
    const auto domain = net.space().lengths;
    held.resize(c.rows(), count);
    spread.resize(c.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const SurfaceSpring& spring = settings.springs[static_cast<std::size_t>(k)];
      held.col(k) = net.functions_at(spring.at[0] * domain[0], spring.at[1] * domain[1]);
      Points load = Points::Zero(c.rows(), 3);
      load.col(0) = held.col(k);
      spread.col(k) = net.solve(load).col(0);
    }
    return {};
  }

  /// The move by forces on the unknowns, springs drawing at its end (Sherman, Morrison and
  /// Woodbury).
  ///
  /// With H the functions at the springs, S their strengths and A = γ M + K: A d = f + H S (to −
  /// Hᵀ(c + d)). λ = S (to − Hᵀ(c + d)) solves (Hᵀ A⁻¹ H + S⁻¹) λ = to − Hᵀ c − Hᵀ A⁻¹ f, a system
  /// as small as there are springs, and d = A⁻¹ f + (A⁻¹ H) λ. In the matrix a spring would couple
  /// all waves and undo the transform.
  [[nodiscard]] Expected<Points> moved_by(Points forces) const {
    const auto count = std::ssize(settings.springs);
    if (count == 0) return net.solve(forces);
    Eigen::MatrixXd pull(count, 3);
    Eigen::VectorXd softness(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const SurfaceSpring& spring = settings.springs[static_cast<std::size_t>(k)];
      pull.row(k) = spring.to.transpose() - held.col(k).transpose() * c;
      softness[k] = 1 / std::max(spring.strength, 1e-300);
    }
    const Points free = net.solve(forces);
    const Eigen::MatrixXd small =
        held.transpose() * spread + Eigen::MatrixXd(softness.asDiagonal());
    const auto drawn = detail::solve_square(small, pull - held.transpose() * free);
    if (!drawn) return std::unexpected(drawn.error().within("springs"));
    return Points(free + spread * *drawn);
  }

  // ∫ x dy dz over the surface, in voxels: n_x dA = (S_u × S_v)_x du dv. Intensity with sums along
  // x in place of x.
  [[nodiscard]] InsideSums inside(const VolumePotential& image) const {
    InsideSums sum;
    const Points v = net.at_gauss(c, 0, 0), u = net.at_gauss(c, 1, 0), w = net.at_gauss(c, 0, 1);
    const Eigen::Matrix3d to_voxels = image.frame().directions.inverse();
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const Eigen::Vector3d at = image.voxel(v.row(q)), a = to_voxels * u.row(q).transpose(),
                            b = to_voxels * w.row(q).transpose();
      const double across = net.weights()[q] * (a[1] * b[2] - a[2] * b[1]);
      sum.volume += across * at[0];
      if (image.settings().region != 0) sum.intensity += across * image.intensity_to_the_left(at);
    }
    return sum;
  }

  /// The mean grey of a band outside, its layers weighted like the surface.
  [[nodiscard]] double grey_around(const VolumePotential& image, double side) const {
    const Points v = net.at_gauss(c, 0, 0), u = net.at_gauss(c, 1, 0), w = net.at_gauss(c, 0, 1);
    double area = 0, sum = 0;
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const Eigen::Vector3d normal = side * u.row(q).cross(w.row(q)).transpose();
      const double size = normal.norm();
      if (!(size > 0)) continue;
      for (int k = 0; k < band_layers; ++k) {
        const double out = settings.band * (k + 0.5) / band_layers;
        sum += net.weights()[q] * size *
               image.intensity(v.row(q).transpose() + out / size * normal) / band_layers;
      }
      area += net.weights()[q] * size;
    }
    return area > 0 ? sum / area : 0;
  }

  /// Forces of the image, of pressure and of volcanoes at the Gauss points, with their weights.
  ///
  /// Weighted by dΩ like the mass matrix: forces and viscosity are per measure of the parameters,
  /// so that the motion of a place does not depend on the net.
  [[nodiscard]] Points forces(const VolumePotential& image, double side,
                              const std::optional<Greys>& greys) const {
    const Points v = net.at_gauss(c, 0, 0);
    const bool flows = image.settings().flow != 0,
               presses = greys || settings.balloon != 0 || flows;
    const Points u = presses ? net.at_gauss(c, 1, 0) : Points(),
                 w = presses ? net.at_gauss(c, 0, 1) : Points();
    Points f(v.rows(), 3);
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const Point place = v.row(q);
      Eigen::Vector3d force = image.force(place);
      for (const SurfaceVolcano& volcano : settings.volcanoes) {
        const Eigen::Vector3d away = place - volcano.at;
        const double distance = away.norm(),
                     share = volcano.radius / std::max(distance, volcano.radius);
        if (distance > 0) force += volcano.strength * share * share * away / distance;
      }
      if (presses) {
        double pressure = settings.balloon;
        if (greys) {
          pressure += image.settings().region * region_pressure(greys->inside, greys->outside,
                                                                image.intensity(place),
                                                                image.settings().relative_region);
        }
        const Eigen::Vector3d normal = side * u.row(q).cross(w.row(q)).transpose().normalized();
        if (flows) pressure += image.flow(place).dot(normal);
        force += pressure * normal;
      }
      f.row(q) = net.weights_on_domain()[q] * force;
    }
    return f;
  }

  // The move d of (γ M + K) d = F − K c, which is c⁺ − c of the implicit step: near rest its right
  // side is small, and the rounding of γ M c plays no part.
  Expected<void> step(const VolumePotential& image, double side,
                      const std::optional<Greys>& greys) {
    auto moved = moved_by(net.load(forces(image, side, greys)) - net.internal(c));
    if (!moved) return std::unexpected(moved.error());
    Points move = limited(std::move(*moved), settings.max_move);
    net.keep_poles(move);
    c += move;
    ++iterations;
    motion.went_to(c, settings.motion);
    if (motion.steadied(move)) {
      if (auto status = prepare(); !status) return status;
    }
    const bool normal =
        image.settings().region != 0 || image.settings().flow != 0 || settings.balloon != 0;
    const bool may = normal && settings.springs.empty() && settings.redistribute > 0;
    if (!may || motion.resting() || iterations % settings.redistribute != 0) return {};
    const Eigen::VectorXd stretch = stretches();
    const bool uneven =
        stretch.minCoeff() > 0 && stretch.maxCoeff() > most_uneven_area * stretch.minCoeff();
    return uneven ? redistribute(stretch) : Expected<void>{};
  }

  /// How much area is stretched at the Gauss points.
  [[nodiscard]] Eigen::VectorXd stretches() const {
    const Points u = net.at_gauss(c, 1, 0), w = net.at_gauss(c, 0, 1);
    Eigen::VectorXd result(u.rows());
    for (Eigen::Index q = 0; q < u.rows(); ++q) {
      result[q] = u.row(q).cross(w.row(q)).norm() * net.weights()[q] / net.weights_on_domain()[q];
    }
    return result;
  }

  /// Moves it within itself so that area J is stretched evenly, to first order: by the places of
  /// parameters shifted by ∇φ with Δφ = mean − log J on Ω, since log J changes by Δφ (J. Moser's
  /// construction, linear).
  ///
  /// The Poisson problem has constants in its null space: 1e-6 of M, in the radius of the domain,
  /// makes it definite and hardly changes φ, as the right side has the mean 0. On a sphere ∇φ has
  /// the components φ_u / sin² and φ_v. The mass matrix turns the shift at Gauss points into one of
  /// the unknowns.
  Expected<void> redistribute(const Eigen::VectorXd& stretch) {
    const double turn = net.space().lengths[0] / (2 * std::numbers::pi);
    if (!mass) {
      auto plain = SurfaceNet::create(net.space(), 0, 0),
           laplace = SurfaceNet::create(net.space(), 1, 0);
      if (!plain || !laplace) return std::unexpected(plain ? laplace.error() : plain.error());
      if (auto status = plain->factor(1, true); !status) return status;
      if (auto status = laplace->factor(nearly_singular / (turn * turn)); !status) return status;
      mass = std::move(*plain);
      poisson = std::move(*laplace);
    }
    const Eigen::VectorXd& weights = net.weights_on_domain();
    Points right = Points::Zero(stretch.size(), 3);
    right.col(0) = stretch.array().log();
    right.col(0).array() -= weights.dot(right.col(0)) / weights.sum();
    const Points phi = poisson->solve(net.load(weights.asDiagonal() * right));
    const Points u = net.at_gauss(c, 1, 0), w = net.at_gauss(c, 0, 1),
                 along_u = net.at_gauss(phi, 1, 0), along_w = net.at_gauss(phi, 0, 1);
    Points within(u.rows(), 3);
    for (Eigen::Index q = 0; q < within.rows(); ++q) {
      const double sine = weights[q] / net.weights()[q];
      within.row(q) =
          weights[q] * (along_u(q, 0) / (sine * sine) * u.row(q) + along_w(q, 0) * w.row(q));
    }
    const Points shift = mass->solve(net.load(within));
    const double longest = shift.rowwise().norm().maxCoeff();
    if (longest > 0) c += shift * std::min(1.0, settings.max_move / longest);
    return {};
  }

  [[nodiscard]] double viscosity() const { return motion.viscosity(settings.gamma); }
  [[nodiscard]] bool ended() const {
    return motion.resting() || iterations >= settings.max_iterations;
  }
};

/// All of them until the last one rests. Sums of all surfaces come first, as those outside of one
/// are what is in none.
Expected<void> run_until_rest(const VolumePotential& image, std::vector<MovingSurface>& snakes) {
  const bool region = image.settings().region != 0;
  const auto [nx, ny, nz] = image.size();
  while (std::ranges::any_of(snakes, [](const MovingSurface& s) { return !s.ended(); })) {
    std::vector<InsideSums> insides;
    double volume = 0, intensity = 0;
    for (const MovingSurface& s : snakes) {
      insides.push_back(s.inside(image));
      volume += std::abs(insides.back().volume);
      intensity += std::copysign(1, insides.back().volume) * insides.back().intensity;
    }
    const double left = double(nx) * ny * nz - volume;
    const double outside = left >= 1 ? (image.total_intensity() - intensity) / left : 0;
    const double turn = std::copysign(1, image.frame().directions.determinant());
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      if (snakes[k].ended()) continue;
      const double side = turn * std::copysign(1, insides[k].volume);
      std::optional<Greys> greys;
      if (region && std::abs(insides[k].volume) >= 1) {
        greys = Greys{insides[k].intensity / insides[k].volume, outside};
        if (snakes[k].settings.band > 0) greys->outside = snakes[k].grey_around(image, side);
      }
      if (auto status = snakes[k].step(image, side, greys); !status) return status;
    }
  }
  return {};
}

Expected<MovingSurface> activated(const SurfaceSnakeSettings& settings, const SurfaceSpace& space,
                                  Points c, int iterations) {
  auto net = SurfaceNet::create(space, settings.alpha, settings.beta);
  if (!net) return std::unexpected(net.error());
  MovingSurface active{settings, std::move(*net), std::move(c)};
  active.iterations = iterations;
  if (auto status = active.prepare(); !status) return std::unexpected(status.error());
  return active;
}

/// How far the surface moves across itself at most, at its Gauss points, towards a finer one.
Expected<double> difference(const MovingSurface& coarse, const MovingSurface& fine) {
  const auto there = fine.net.surface(fine.c);
  if (!there) return std::unexpected(there.error());
  const auto places =
      evaluate_grid(there->surface, {std::span(coarse.net.quadrature(0).parameters),
                                     std::span(coarse.net.quadrature(1).parameters)});
  if (!places) return std::unexpected(places.error());
  const Points v = coarse.net.at_gauss(coarse.c, 0, 0), u = coarse.net.at_gauss(coarse.c, 1, 0),
               w = coarse.net.at_gauss(coarse.c, 0, 1);
  double most = 0;
  for (Eigen::Index q = 0; q < v.rows(); ++q) {
    const Eigen::RowVector3d normal = u.row(q).cross(w.row(q)).normalized();
    most = std::max(most, std::abs((places->points().row(q) - v.row(q)).dot(normal)));
  }
  return most;
}

/// Halves all spans of surfaces that rest, where that moves them, until it does not.
Expected<void> refine_all(const VolumePotential& image, std::vector<MovingSurface>& snakes) {
  for (bool again = true; again;) {
    again = false;
    std::vector<MovingSurface> fine;
    std::vector<bool> refined;
    for (const MovingSurface& s : snakes) {
      const SurfaceSpace halves = s.net.space().halved();
      const bool may = s.settings.refine > 0 && s.iterations < s.settings.max_iterations &&
                       halves.unknowns() <= s.settings.max_control_points;
      refined.push_back(may);
      fine.push_back(s);
      if (!may) {
        fine.back().motion.stop();
        continue;
      }
      const auto here = s.net.surface(s.c);
      if (!here) return std::unexpected(here.error());
      auto c = projected(halves, *here);
      if (!c) return std::unexpected(c.error());
      auto finer = activated(s.settings, halves, std::move(*c), s.iterations);
      if (!finer) return std::unexpected(finer.error());
      fine.back() = std::move(*finer);
    }
    if (auto status = run_until_rest(image, fine); !status) return status;
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      if (!refined[k]) continue;
      const auto moved = difference(snakes[k], fine[k]);
      if (!moved) return std::unexpected(moved.error());
      if (*moved > snakes[k].settings.refine) {
        snakes[k] = std::move(fine[k]);
        again = true;
      } else {
        snakes[k].iterations = fine[k].iterations;
        snakes[k].settings.refine = 0;  // it follows the image
      }
    }
  }
  return {};
}

}  // namespace

// A start must fulfil the conditions at its poles: `solve` returns moves that do, and a start that
// does not would keep its kink.
Expected<std::vector<SurfaceSnakeResult>> run_surface_snakes(
    const VolumePotential& potential, std::vector<ClosedSurface> starts,
    const std::vector<SurfaceSnakeSettings>& settings) {
  if (starts.size() != settings.size())
    return input_error("every surface needs its settings", "snakes");
  std::vector<MovingSurface> snakes;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto in = [k](const Error& error) {
      return std::unexpected(error.within(fmt::format("snakes[{}]", k)));
    };
    if (auto checked = check_settings(settings[k]); !checked) return in(checked.error());
    const auto space = space_of(starts[k]);
    if (!space) return in(space.error());
    auto active = activated(settings[k], *space, Points::Zero(space->unknowns(), 3), 0);
    if (!active) return in(active.error());
    active->c = active->net.unknowns_of(starts[k].surface);
    Points kept = active->c;
    active->net.keep_poles(kept);
    const double size = (active->c.colwise().maxCoeff() - active->c.colwise().minCoeff()).norm();
    if (!((kept - active->c).cwiseAbs().maxCoeff() <= 1e-9 * size)) {
      return in({ErrorKind::input, "its poles are not those of an active surface", "",
                 "use closed_surface"});
    }
    snakes.push_back(std::move(*active));
  }
  if (auto status = run_until_rest(potential, snakes); !status)
    return std::unexpected(status.error());
  if (auto refined = refine_all(potential, snakes); !refined)
    return std::unexpected(refined.error());
  std::vector<SurfaceSnakeResult> results;
  for (const MovingSurface& s : snakes) {
    auto surface = s.net.surface(s.c);
    if (!surface) return std::unexpected(surface.error());
    results.push_back({std::move(*surface), s.iterations, s.motion.resting(), s.motion.last()});
  }
  return results;
}

}  // namespace knead
