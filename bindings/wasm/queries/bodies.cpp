// Curves and volumes, and the block of the command `lattice`.
#include "knead/spline/evaluate.hpp"
#include "query.hpp"
#include "scene/lattice.hpp"
#include "scene/shape.hpp"
#include "spline/grid_lines.hpp"

namespace knead::studio {
namespace {

/// A curve or a volume to draw; places relative to the requested origin, 3 numbers each.
struct BodyPicture {
  std::vector<float>
      lines;  ///< ends of chords: of a curve, or of the knot lines on the sides of a volume
  std::vector<float> at;  ///< where these ends are, three fractions of the domain each; of a curve
                          ///< the first counts
  std::vector<float>
      net;  ///< ends of the legs of the control polygon; of a volume those on its sides
  std::vector<float> points;  ///< the control points, in their order
  bool pulled = false;        ///< of a lattice: it has been pulled, and another pull goes on there
};

void describe(BodyPicture& p, Fields& fields) {
  fields.name("body picture", "A curve or a volume to draw, relative to the session's origin.");
  fields.add("lines", p.lines,
             {.help = "ends of chords: of a curve, or of knot lines on the sides of a volume"});
  fields.add("at", p.at, {.help = "three fractions of the domain for each end"});
  fields.add("net", p.net, {.help = "ends of the legs of the control polygon"});
  fields.add("points", p.points, {.help = "the control points"});
  fields.add("pulled", p.pulled,
             {.help = "of a lattice: it has been pulled, and another pull goes on there"});
}

constexpr int curve_chords = 24, volume_chords = 6;
constexpr std::size_t most_lines = 12;

void append(std::vector<float>& to, const Point& place, const Point& origin) {
  for (Eigen::Index d = 0; d < 3; ++d) to.push_back(static_cast<float>(place[d] - origin[d]));
}

/// The ends of the domain, and knots between them, not all where there are many.
std::vector<double> lines_across(const KnotVector& knots) {
  std::vector<double> inner;
  for (const int span : knots.spans()) inner.push_back(knots[span]);
  const std::size_t stride = inner.size() / most_lines + 1;
  std::vector<double> places;
  for (std::size_t k = 0; k < inner.size(); k += stride) places.push_back(inner[k]);
  places.push_back(knots.domain().upper);
  return places;
}

double fraction(const KnotVector& knots, double u) {
  const Interval domain = knots.domain();
  return (u - domain.lower) / (domain.upper - domain.lower);
}

Expected<void> draw(const Curve& curve, const Point& origin, BodyPicture& to) {
  const std::vector<double> places = even_parameters(curve.knots(0), curve_chords);
  const auto points = evaluate_grid<1>(curve, {std::span<const double>(places)});
  if (!points) return std::unexpected(points.error());
  for (Eigen::Index k = 0; k + 1 < points->points().rows(); ++k) {
    for (const Eigen::Index end : {k, k + 1}) {
      append(to.lines, points->points().row(end).transpose(), origin);
      append(to.at, Point(fraction(curve.knots(0), places[static_cast<std::size_t>(end)]), 0, 0),
             Point::Zero());
    }
  }
  return {};
}

Expected<void> draw(const Volume& volume, const Point& origin, BodyPicture& to) {
  for (std::size_t d = 0; d < 3; ++d) {
    std::array<std::vector<double>, 3> places;
    for (std::size_t e = 0; e < 3; ++e) {
      places[e] = e == d ? even_parameters(volume.knots()[e], volume_chords)
                         : lines_across(volume.knots()[e]);
    }
    const auto points = evaluate_grid<3>(volume, {places[0], places[1], places[2]});
    if (!points) return std::unexpected(points.error());
    const auto row = [&](std::array<std::size_t, 3> at) {
      return points->points()
          .row(static_cast<Eigen::Index>((at[0] * places[1].size() + at[1]) * places[2].size() +
                                         at[2]))
          .transpose();
    };
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    for (std::size_t i = 0; i < places[e].size(); ++i) {
      for (std::size_t j = 0; j < places[f].size(); ++j) {
        const bool outside =
            i == 0 || j == 0 || i + 1 == places[e].size() || j + 1 == places[f].size();
        for (std::size_t k = 0; outside && k + 1 < places[d].size(); ++k) {
          std::array<std::size_t, 3> at{};
          at[e] = i;
          at[f] = j;
          for (const std::size_t end : {k, k + 1}) {
            at[d] = end;
            append(to.lines, row(at), origin);
            Point share;
            for (std::size_t g = 0; g < 3; ++g) {
              share[static_cast<Eigen::Index>(g)] = fraction(volume.knots()[g], places[g][at[g]]);
            }
            append(to.at, share, Point::Zero());
          }
        }
      }
    }
  }
  return {};
}

template <int D>
void draw_net(const Spline<D>& spline, const Point& origin, BodyPicture& picture) {
  std::vector<float>& to = picture.net;
  const auto net = spline.net();
  const Points& points = spline.control_points();
  for (int k = 0; k < spline.size(); ++k) {
    append(picture.points, points.row(k).transpose(), origin);
    std::array<int, D> at;
    for (int d = D - 1, rest = k; d >= 0; --d) {
      at[static_cast<std::size_t>(d)] = rest % net[static_cast<std::size_t>(d)];
      rest /= net[static_cast<std::size_t>(d)];
    }
    int stride = 1;
    for (std::size_t d = D; d-- > 0; stride *= net[d]) {
      if (at[d] + 1 == net[d]) continue;
      bool outside = D == 1;
      for (std::size_t e = 0; e < D; ++e)
        outside = outside || (e != d && (at[e] == 0 || at[e] + 1 == net[e]));
      if (!outside) continue;
      append(to, points.row(k).transpose(), origin);
      append(to, points.row(k + stride).transpose(), origin);
    }
  }
}

template <int D>
Expected<BodyPicture> picture_of(const Spline<D>& spline, const Point& origin) {
  BodyPicture picture;
  if (auto status = draw(spline, origin, picture); !status) return std::unexpected(status.error());
  draw_net(spline, origin, picture);
  return picture;
}

struct BodyPictureQuery {
  using Answer = BodyPicture;
  int body = 0;
};

void describe(BodyPictureQuery& q, Fields& fields) {
  fields.name(
      "body_picture",
      "A curve or a volume to draw: 24 chords per span of a curve, 6 of a volume's knot lines, "
      "of which at most 12 per direction are drawn.");
  fields.add("body", q.body, {.help = "its number", .presence = Presence::required});
}

Expected<BodyPicture> ask(Studio& studio, const BodyPictureQuery& q) {
  if (!studio.session) return nothing_open();
  const auto& bodies = studio.session->state().bodies;
  if (q.body < 0 || q.body >= static_cast<int>(bodies.size()))
    return usage_error("there is no such body");
  return std::visit([&](const auto& s) { return picture_of(*s.current, studio.origin); },
                    bodies[static_cast<std::size_t>(q.body)]);
}

struct LatticePictureQuery {
  using Answer = BodyPicture;
  std::array<int, 3> net = {4, 4, 4};
  double margin = 0;
  bool anew = false;
};

void describe(LatticePictureQuery& q, Fields& fields) {
  fields.name("lattice_picture",
              "The block that the next command `lattice` by hand moves: as it was pulled, if that "
              "goes on, or round the selected surfaces.");
  fields.add("net", q.net,
             {.help = "control points along x, y, z", .presence = Presence::required});
  fields.add("margin", q.margin, {.help = "around the surfaces", .presence = Presence::required});
  fields.add("anew", q.anew,
             {.help = "round the surfaces as they are, whether or not one was pulled"});
}

Expected<BodyPicture> ask(Studio& studio, const LatticePictureQuery& q) {
  if (!studio.session) return nothing_open();
  const Scene& scene = studio.session->state();
  const auto& [net, margin, anew] = q;
  constexpr std::array<int, 3> degree = {3, 3, 3};
  const PulledLattice* pulled = anew ? nullptr : lattice_to_pull_on(scene, margin, degree, net);
  const auto lattice = pulled != nullptr ? lattice_around(pulled->before, margin, degree, net)
                                         : lattice_around_selection(scene, margin, degree, net);
  if (!lattice) return std::unexpected(lattice.error());
  if (pulled == nullptr) return picture_of(lattice->rest(), studio.origin);
  const auto block = lattice->rest().with_control_points(pulled->points);
  if (!block) return std::unexpected(block.error());
  auto picture = picture_of(*block, studio.origin);
  if (picture) picture->pulled = true;
  return picture;
}

}  // namespace

std::vector<Query> body_queries() {
  return {query<BodyPictureQuery>(), query<LatticePictureQuery>()};
}

}  // namespace knead::studio
