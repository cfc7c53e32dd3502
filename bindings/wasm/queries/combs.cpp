// Curvature combs of surfaces, of their parameter lines and of plane sections.
#include "query.hpp"
#include "spline/curvature_comb.hpp"
#include "spline/section_comb.hpp"

namespace knead::studio {
namespace {

/// Curvature combs to draw, those teeth that are visible.
struct Combs {
  std::vector<float> places, vectors;  ///< 3 per tooth; places relative to the requested origin
  std::vector<std::uint8_t>
      joined;                ///< per tooth: 1 if it continues the comb of the tooth before it
  double largest = 0;        ///< curvature of any visible tooth, 1/length
  Point at = Point::Zero();  ///< where that is, relative to the origin
};

void describe(Combs& c, Fields& fields) {
  fields.name("combs", "Curvature combs of a surface, those teeth that are visible.");
  fields.add("places", c.places, {.help = "relative to the session's origin"});
  fields.add("vectors", c.vectors, {.help = "towards the centre of curvature, 1/length"});
  fields.add("joined", c.joined,
             {.help = "per tooth: 1 if it continues the comb of the tooth before it"});
  fields.add("largest", c.largest, {.help = "curvature of any visible tooth, 1/length"});
  fields.add("at", c.at, {.help = "where that is, relative to the origin"});
}

/// Puts teeth into a picture, those that are visible.
class CombDrawer {
 public:
  CombDrawer(const Surface& surface, Point origin, const VisibleRegion* visible)
      : surface_(surface), origin_(std::move(origin)), visible_(visible) {}
  Combs picture;

  /// The next tooth is the first of a comb.
  void begin() { joined_ = false; }
  void add(const std::array<double, 2>& parameters, const Point& on, const Point& vector) {
    if (visible_ != nullptr &&
        !visible_->contains({fraction(0, parameters[0]), fraction(1, parameters[1])})) {
      joined_ = false;
      return;
    }
    const Point place = on - origin_;
    for (int d = 0; d < 3; ++d) {
      picture.places.push_back(static_cast<float>(place[d]));
      picture.vectors.push_back(static_cast<float>(vector[d]));
    }
    picture.joined.push_back(joined_ ? 1 : 0);
    joined_ = true;
    if (const double size = vector.norm(); size > picture.largest) {
      picture.largest = size;
      picture.at = place;
    }
  }

 private:
  [[nodiscard]] double fraction(int d, double u) const {
    const Interval domain = surface_.knots(d).domain();
    return (u - domain.lower) / domain.length();
  }
  const Surface& surface_;
  Point origin_;
  const VisibleRegion* visible_;
  bool joined_ = false;
};

struct CombsQuery {
  using Answer = Combs;
  int surface = 0, along_u = 0, along_v = 0, teeth = 0;
};

void describe(CombsQuery& q, Fields& fields) {
  fields.name("combs", "Curvature combs of a surface along parameter lines.");
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
  fields.add_pair(
      "curves", q.along_u, q.along_v,
      {.help = "on how many u runs and on how many v does", .presence = Presence::required});
  fields.add("teeth", q.teeth,
             {.help = "pieces of every knot span", .presence = Presence::required});
}

Expected<Combs> ask(Studio& studio, const CombsQuery& q) {
  if (!studio.session) return nothing_open();
  const auto of = surface_of(*studio.session, q.surface);
  if (!of) return std::unexpected(of.error());
  const Surface& surface = *(*of)->current;
  const auto combs = curvature_combs(surface, {{q.along_u, q.along_v}, q.teeth});
  if (!combs) return std::unexpected(combs.error());
  const auto visible = visible_part(studio, q.surface);
  CombDrawer drawer(surface, studio.origin, visible.get());
  for (const CurvatureComb& comb : *combs) {
    drawer.begin();
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      const double runs = comb.runs[static_cast<std::size_t>(k)];
      drawer.add(comb.direction == 0 ? std::array{runs, comb.at} : std::array{comb.at, runs},
                 comb.places.row(k).transpose(), comb.vectors.row(k).transpose());
    }
  }
  return std::move(drawer.picture);
}

struct SectionCombsQuery {
  using Answer = Combs;
  int surface = 0;
  std::array<double, 4> plane = {0, 0, 1, 0};
};

void describe(SectionCombsQuery& q, Fields& fields) {
  fields.name("section_combs", "Those of the curves in which a plane cuts a surface.");
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
  fields.add("plane", q.plane,
             {.help = "points p of the file with (x, y, z) · p = offset; (x, y, z) is of length 1",
              .presence = Presence::required});
}

/// Teeth are as dense as chords that are within 1e-3 of the extent of the control points.
Expected<Combs> ask(Studio& studio, const SectionCombsQuery& q) {
  if (!studio.session) return nothing_open();
  const auto of = surface_of(*studio.session, q.surface);
  if (!of) return std::unexpected(of.error());
  const Surface& surface = *(*of)->current;
  constexpr double dense = 1e-3;
  const Points& net = surface.control_points();
  const double extent = (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  const auto combs = section_combs(surface, {{q.plane[0], q.plane[1], q.plane[2]}, q.plane[3]},
                                   extent > 0 ? dense * extent : 1);
  if (!combs) return std::unexpected(combs.error());
  const auto visible = visible_part(studio, q.surface);
  CombDrawer drawer(surface, studio.origin, visible.get());
  for (const SectionComb& comb : *combs) {
    drawer.begin();
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      drawer.add({comb.parameters(k, 0), comb.parameters(k, 1)}, comb.places.row(k).transpose(),
                 comb.vectors.row(k).transpose());
    }
  }
  return std::move(drawer.picture);
}

}  // namespace

std::vector<Query> comb_queries() { return {query<CombsQuery>(), query<SectionCombsQuery>()}; }

}  // namespace knead::studio
