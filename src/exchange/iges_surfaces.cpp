#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "iges_curves.hpp"
#include "part21_text.hpp"

namespace knead::iges {
namespace {

class SurfaceReader {
 public:
  SurfaceReader(const File& file, StepRecords& records, CurveReader& curves)
      : file_(file), records_(records), curves_(curves) {}

  std::string coefficient_plane(int number, const Parameters& parameters, const Eigen::Affine3d& move) {
    const auto v = numbers(file_, number, parameters, 1, 4);  // A x + B y + C z = D
    const Point n = v ? Point((*v)[0], (*v)[1], (*v)[2]) : Point::Zero();
    if (!(n.norm() > 0)) return {};
    const Point z = move.linear() * n;
    return fmt::format("PLANE('',#{})",
                       records_.frame(move * Point(n * (*v)[3] / n.squaredNorm()), z, z.unitOrthogonal()));
  }

  std::string elementary(const Parameters& parameters, const Eigen::Affine3d& move, int type) {
    const auto& values = parameters.values;
    const auto pointer = [&](std::size_t k) { return k < values.size() ? integer(values[k]).value_or(0) : 0; };
    const auto number = [&](std::size_t k) { return k < values.size() ? real(values[k]).value_or(0) : 0.0; };
    const bool sphere = type == 196;
    const auto location = place(pointer(1));
    if (!location) return {};
    const auto axis = place(pointer(sphere ? 3 : 2));
    if (!axis && !sphere) return {};
    const std::size_t lengths = type == 190 ? 0 : type == 194 || type == 198 ? 2 : 1;
    const auto reference = place(pointer(sphere ? 4 : 3 + lengths));
    const Point z = move.linear() * (axis ? *axis : Point::UnitZ());
    const Point x = reference ? Point(move.linear() * *reference) : z.unitOrthogonal();
    const int frame = records_.frame(move * *location, z, x);
    const std::string a = format_real(number(sphere ? 2 : 3)), b = format_real(number(4));
    switch (type) {
      case 190:
        return fmt::format("PLANE('',#{})", frame);
      case 192:
        return fmt::format("CYLINDRICAL_SURFACE('',#{},{})", frame, a);
      case 194:
        return fmt::format("CONICAL_SURFACE('',#{},{},{})", frame, a, format_real(number(4) * std::numbers::pi / 180));
      case 196:
        return fmt::format("SPHERICAL_SURFACE('',#{},{})", frame, a);
      case 198:
        return fmt::format("TOROIDAL_SURFACE('',#{},{},{})", frame, a, b);
      default:
        return {};
    }
  }

  /// A surface of revolution (120: axis, generatrix) or a tabulated cylinder (122: directrix, end of its generatrix).
  std::string swept(int number, const Parameters& parameters, const Eigen::Affine3d& move) {
    const bool turned = file_.find(number)->type == 120;
    const auto pointer = [&](std::size_t k) {
      return k < parameters.values.size() ? integer(parameters.values[k]).value_or(0) : 0;
    };
    std::vector<Piece> axis, profile;
    if (!curves_.add(pointer(turned ? 2 : 1), move, profile) || profile.size() != 1) return {};
    if (turned) {
      if (!curves_.add(pointer(1), move, axis) || axis.size() != 1 || axis[0].from() == axis[0].to()) return {};
      // IGES has S(t, θ), STEP S(θ, t): turned about the opposite axis the normals are the same.
      const int point = records_.point(axis[0].from()), direction = records_.direction(axis[0].from() - axis[0].to());
      const int line = records_.add(fmt::format("AXIS1_PLACEMENT('',#{},#{})", point, direction));
      return fmt::format("SURFACE_OF_REVOLUTION('',#{},#{})", profile[0].geometry, line);
    }
    const auto end = numbers(file_, number, parameters, 2, 3);
    if (!end) return {};
    const Point sweep = move * Point((*end)[0], (*end)[1], (*end)[2]) - profile[0].from();
    if (!(sweep.norm() > 0)) return {};
    const int vector = records_.add(fmt::format("VECTOR('',#{},1.)", records_.direction(sweep)));
    return fmt::format("SURFACE_OF_LINEAR_EXTRUSION('',#{},#{})", profile[0].geometry, vector);
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
  StepRecords& records_;
  CurveReader& curves_;
};

}  // namespace

std::string surface_record(const File& file, int number, const Eigen::Affine3d& outer, StepRecords& records,
                           CurveReader& curves) {
  const Entity* entity = file.find(number);
  const auto own = transform_of(file, number);
  const auto parameters = file.parameters(number);
  const int type = entity != nullptr ? entity->type : 0;
  std::string record;
  if (own && parameters) {
    SurfaceReader reader(file, records, curves);
    const Eigen::Affine3d move = outer * *own;
    if (type == 108) record = reader.coefficient_plane(number, *parameters, move);
    if (type == 120 || type == 122) record = reader.swept(number, *parameters, move);
    if (type >= 190 && type <= 198) record = reader.elementary(*parameters, move, type);
  }
  return record.empty() ? fmt::format("IGES_SURFACE_{}('D{}')", type, number) : record;
}

}  // namespace knead::iges
