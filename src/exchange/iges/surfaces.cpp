#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "brep/geometry_forms.hpp"
#include "curves.hpp"

namespace knead::iges {
namespace {

using brep::ElementarySurface;
using Kind = ElementarySurface::Kind;

struct KnownSurface {
  int type;
  const char* kind;
  Kind form;
  std::size_t lengths;
};

constexpr std::array<KnownSurface, 5> known_surfaces = {
    {{190, "PLANE", Kind::plane, 0},
     {192, "CYLINDRICAL_SURFACE", Kind::cylinder, 1},
     {194, "CONICAL_SURFACE", Kind::cone, 2},
     {196, "SPHERICAL_SURFACE", Kind::sphere, 1},
     {198, "TOROIDAL_SURFACE", Kind::torus, 2}}};

class SurfaceReader {
 public:
  SurfaceReader(const File& file, CurveReader& curves) : file_(file), curves_(curves) {}

  /// A x + B y + C z = D.
  Expected<ElementarySurface> coefficient_plane(int number, const Parameters& parameters,
                                                const Eigen::Affine3d& move) {
    const auto v = numbers(file_, number, parameters, 1, 4);
    const Point n = v ? Point((*v)[0], (*v)[1], (*v)[2]) : Point::Zero();
    if (!(n.norm() > 0)) return file_.error(number, "it has no normal");
    const Point z = move.linear() * n;
    return brep::elementary_of(
        Kind::plane,
        brep::frame_of(move * Point(n * (*v)[3] / n.squaredNorm()), z, z.unitOrthogonal()));
  }

  // Location (116), axis (123), lengths, and in form 1 a reference direction (123); of spheres the
  // radius comes before the axis. The half angle of a cone is in degrees, whatever the units of the
  // file.
  Expected<ElementarySurface> elementary(const Parameters& parameters, const Eigen::Affine3d& move,
                                         const KnownSurface& known) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) {
      return k < values.size() ? integer(values[k]).value_or(0) : 0;
    };
    const auto number = [&](std::size_t k) {
      return k < values.size() ? real(values[k]).value_or(0) : 0.0;
    };
    const bool sphere = known.form == Kind::sphere, cone = known.form == Kind::cone;
    const auto location = place(pointer(1));
    if (!location) return std::unexpected(location.error());
    const auto axis = place(pointer(sphere ? 3 : 2));
    if (!axis && !sphere) return std::unexpected(axis.error());
    const auto reference = place(pointer(sphere ? 4 : 3 + known.lengths));
    const Point z = move.linear() * (axis ? *axis : Point::UnitZ());
    const Point x = reference ? Point(move.linear() * *reference) : z.unitOrthogonal();
    const double second = cone ? number(4) * std::numbers::pi / 180 : number(4);
    return brep::elementary_of(known.form, brep::frame_of(move * *location, z, x),
                               number(sphere ? 2 : 3), second);
  }

  /// A surface of revolution (120: axis, generatrix) or a tabulated cylinder (122: directrix, end
  /// of its generatrix).
  Expected<brep::SweptSurface> swept(int number, const Parameters& parameters,
                                     const Eigen::Affine3d& move) {
    const bool turned = file_.find(number)->type == 120;
    const auto pointer = [&](std::size_t k) {
      return k < parameters.values.size() ? integer(parameters.values[k]).value_or(0) : 0;
    };
    std::vector<Piece> axis, profile;
    if (auto read = curves_.add(pointer(turned ? 2 : 1), move, profile); !read)
      return std::unexpected(read.error());
    if (profile.size() != 1) return file_.error(number, "its curve is made of several");
    brep::SweptSurface surface;
    surface.revolution = turned;
    if (profile[0].geometry)
      surface.curve = std::make_shared<const brep::CurveGeometry>(*std::move(profile[0].geometry));
    else
      surface.wrong = brep::fault(profile[0].geometry.error());
    if (turned) {
      const auto read = curves_.add(pointer(1), move, axis);
      if (!read || axis.size() != 1 || axis[0].from() == axis[0].to())
        return file_.error(number, "it has no axis");
      // IGES has S(t, θ), the model S(θ, t): turned about the opposite axis the normals are the
      // same.
      surface.frame = brep::frame_about(axis[0].from(), axis[0].from() - axis[0].to());
      return surface;
    }
    const auto end = numbers(file_, number, parameters, 2, 3);
    if (!end) return std::unexpected(end.error());
    const Point sweep = move * Point((*end)[0], (*end)[1], (*end)[2]) - profile[0].from();
    if (!(sweep.norm() > 0)) return file_.error(number, "it is swept by no length");
    surface.frame = brep::frame_about(Point::Zero(), sweep);
    return surface;
  }

 private:
  /// The coordinates of a point (116) or direction (123).
  Expected<Point> place(int number) const {
    const auto parameters = file_.parameters(number);
    if (!parameters) return std::unexpected(parameters.error());
    const auto v = numbers(file_, number, *parameters, 1, 3);
    if (!v) return std::unexpected(v.error());
    return Point((*v)[0], (*v)[1], (*v)[2]);
  }

  const File& file_;
  CurveReader& curves_;
};

}  // namespace

brep::Support other_surface(const File& file, int number, const Eigen::Affine3d& outer,
                            CurveReader& curves) {
  const Entity* entity = file.find(number);
  const auto transform = transform_of(file, number);
  const auto parameters = file.parameters(number);
  const int type = entity != nullptr ? entity->type : 0;
  brep::Support support;
  support.id = fmt::format("#{}", number);
  support.kind = fmt::format("IGES_SURFACE_{}", type);
  if (!transform || !parameters) return support;
  SurfaceReader reader(file, curves);
  const Eigen::Affine3d move = outer * *transform;
  const auto fill = [&](const char* kind, auto form) {
    if (!form) return;
    support.kind = kind;
    support.form = *std::move(form);
  };
  if (type == 108) fill("PLANE", reader.coefficient_plane(number, *parameters, move));
  if (type == 120) fill("SURFACE_OF_REVOLUTION", reader.swept(number, *parameters, move));
  if (type == 122) fill("SURFACE_OF_LINEAR_EXTRUSION", reader.swept(number, *parameters, move));
  const auto known = std::ranges::find(known_surfaces, type, &KnownSurface::type);
  if (known != known_surfaces.end())
    fill(known->kind, reader.elementary(*parameters, move, *known));
  return support;
}

}  // namespace knead::iges
