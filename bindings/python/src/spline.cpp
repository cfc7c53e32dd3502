#include <array>

#include "binding.hpp"
#include "knead/spline/closest_point.hpp"
#include "knead/spline/curvature.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace knead::python {
namespace {

/// The arrays of a sequence, as they are for as long as this lives.
std::vector<Doubles> arrays_of(const py::sequence& arrays, bool writable) {
  std::vector<Doubles> result;
  for (const py::handle array : arrays) result.emplace_back(array, writable);
  return result;
}

template <int D>
Held<D> create(const std::array<int, D>& degree, const py::sequence& knots,
               const py::object& control_points, const py::object& weights) {
  const auto make = [&]<std::size_t... d>(std::index_sequence<d...>) {
    const auto lists = arrays_of(knots, false);
    const auto vector_of = [&](std::size_t direction) {
      auto made = KnotVector::create(degree[direction], lists[direction].vector());
      if (!made)
        raise(made.error().within(D == 1 ? "knots" : "knots[" + std::to_string(direction) + "]"));
      return *std::move(made);
    };
    return std::array<KnotVector, D>{vector_of(d)...};
  };
  auto vectors = make(std::make_index_sequence<D>());
  auto points = points_of(Doubles(control_points));
  auto list = weights.is_none() ? std::vector<double>() : Doubles(weights).vector();
  return {std::make_shared<const Spline<D>>(
      value_of(Spline<D>::create(std::move(vectors), std::move(points), std::move(list))))};
}

/// Into memory of the caller. \param grid the parameters of each direction are combined; else those
/// of a point side by side
template <int D>
void evaluate_into(const Held<D>& held, const py::sequence& parameters, int order, bool left,
                   bool grid, const py::sequence& out) {
  const auto at = arrays_of(parameters, false), memory = arrays_of(out, true);
  value_of(without_interpreter([&]() -> Expected<void> {
    const Side side = left ? Side::left : Side::right;
    std::vector<std::span<double>> parts;
    for (const Doubles& part : memory) parts.push_back(part.span());
    std::array<BasisTable, D> tables;
    std::array<const BasisTable*, D> pointers;
    for (std::size_t d = 0; d < D; ++d) {
      auto table = tabulate_basis(held.spline->knots()[d], at[d].span(), order, side);
      if (!table) return std::unexpected(table.error().within("direction " + std::to_string(d)));
      tables[d] = *std::move(table);
      pointers[d] = &tables[d];
    }
    return grid ? evaluate_grid_into<D>(*held.spline, pointers, order, parts)
                : evaluate_into<D>(*held.spline, pointers, order, parts);
  }));
}

template <int D>
void evaluate_one(const Held<D>& held, const py::object& out, const std::array<double, D>& at) {
  const Point point = value_of(evaluate_point<D>(*held.spline, at));
  Py_buffer memory{};
  if (PyObject_GetBuffer(out.ptr(), &memory, PyBUF_WRITABLE) != 0) throw py::error_already_set();
  std::copy_n(point.data(), 3, static_cast<double*>(memory.buf));
  PyBuffer_Release(&memory);
}

template <int D>
Held<D> inserted(const Held<D>& held, const std::array<std::vector<double>, D>& knots) {
  auto made = without_interpreter([&] { return insert_knots<D>(*held.spline, knots); });
  return {std::make_shared<const Spline<D>>(value_of(std::move(made)))};
}

template <int D>
Held<D> elevated(const Held<D>& held, int direction, int times) {
  auto made =
      without_interpreter([&] { return elevate_degree<D>(*held.spline, direction, times); });
  return {std::make_shared<const Spline<D>>(value_of(std::move(made)))};
}

template <int D>
py::tuple without_knots(const Held<D>& held, int direction, double tolerance) {
  auto removal = value_of(
      without_interpreter([&] { return remove_knots<D>(*held.spline, direction, tolerance); }));
  const auto count = static_cast<py::ssize_t>(removal.removed.size());
  return py::make_tuple(Held<D>{std::make_shared<const Spline<D>>(std::move(removal.spline))},
                        view_of_own(std::move(removal.removed), {count}), removal.error_bound);
}

/// Per point: curvature, then the vectors of `CurveCurvature`.
void curvatures(const Held<1>& held, const py::sequence& parameters, bool left,
                const py::object& out) {
  const Doubles at(parameters[0]), to(out, true);
  value_of(without_interpreter([&]() -> Expected<void> {
    double* p = to.span().data();
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto c = curvature(*held.spline, at.span()[k], left ? Side::left : Side::right);
      if (!c) return std::unexpected(c.error().within("point " + std::to_string(k)));
      *p++ = c->curvature;
      for (const Point* v : {&c->tangent, &c->normal}) p = std::copy(v->begin(), v->end(), p);
    }
    return {};
  }));
}

/// Per point: mean, Gaussian, the principal ones, then the vectors of `SurfaceCurvature`.
void curvatures(const Held<2>& held, const py::sequence& parameters, bool left,
                const py::object& out) {
  const Doubles u(parameters[0]), v(parameters[1]), to(out, true);
  value_of(without_interpreter([&]() -> Expected<void> {
    double* p = to.span().data();
    for (std::size_t k = 0; k < u.size(); ++k) {
      const auto c =
          curvature(*held.spline, {u.span()[k], v.span()[k]}, left ? Side::left : Side::right);
      if (!c) return std::unexpected(c.error().within("point " + std::to_string(k)));
      for (const double x : {c->mean, c->gaussian, c->principal[0], c->principal[1]}) *p++ = x;
      for (const Point* w : {&c->normal, &c->directions[0], &c->directions[1]})
        p = std::copy(w->begin(), w->end(), p);
    }
    return {};
  }));
}

void normals(const Held<2>& held, const py::sequence& parameters, bool left,
             const py::object& out) {
  const Doubles u(parameters[0]), v(parameters[1]), to(out, true);
  Parameters<2> at(static_cast<Eigen::Index>(u.size()), 2);
  for (std::size_t k = 0; k < u.size(); ++k)
    at.row(static_cast<Eigen::Index>(k)) << u.span()[k], v.span()[k];
  const Points made = value_of(without_interpreter(
      [&] { return unit_normals(*held.spline, at, left ? Side::left : Side::right); }));
  std::copy_n(made.data(), made.size(), to.span().data());
}

template <int D>
void nearest(const ClosestPointSearch<D>& search, const py::object& points,
             const py::object& parameters, const py::object& distances) {
  const Doubles from(points), at(parameters, true), apart(distances, true);
  without_interpreter([&] {
    const Points places = points_of(from);
    for (Eigen::Index k = 0; k < places.rows(); ++k) {
      const ClosestPoint<D> found = search.nearest(places.row(k).transpose());
      std::ranges::copy(found.parameters, at.span().begin() + k * D);
      apart.span()[static_cast<std::size_t>(k)] = found.distance;
    }
  });
}

template <int D>
void bind(py::module_& module, const char* name) {
  py::class_<Held<D>> type(module, name);
  type.def_static("create", [](const py::tuple& degree, const py::sequence& knots,
                               const py::object& control_points, const py::object& weights) {
    std::array<int, D> degrees{};
    for (std::size_t d = 0; d < D; ++d) degrees[d] = degree[d].template cast<int>();
    return create<D>(degrees, knots, control_points, weights);
  });
  type.def_property_readonly("degree", [](const Held<D>& held) {
    py::tuple degree(D);
    for (int d = 0; d < D; ++d)
      degree[static_cast<std::size_t>(d)] = held.spline->knots(d).degree();
    return degree;
  });
  type.def("knots", [](const Held<D>& held, int direction) {
    const auto knots = held.spline->knots(direction).knots();
    return view_of(held.spline, knots.data(), {std::ssize(knots)});
  });
  type.def("control_points", [](const Held<D>& held) {
    const auto net = held.spline->net();
    std::vector<py::ssize_t> shape(net.begin(), net.end());
    shape.push_back(3);
    return view_of(held.spline, held.spline->control_points().data(), std::move(shape));
  });
  type.def("weights", [](const Held<D>& held) -> std::optional<View> {
    if (!held.spline->rational()) return std::nullopt;
    const auto net = held.spline->net();
    return view_of(held.spline, held.spline->weights().data(), {net.begin(), net.end()});
  });
  type.def("same_object", [](const Held<D>& a, const Held<D>& b) { return a.spline == b.spline; });
  type.def("evaluate", &evaluate_into<D>);
  if constexpr (D == 1) {
    type.def("point", [](const Held<D>& s, const py::object& out, double u) {
      evaluate_one<D>(s, out, {u});
    });
  } else if constexpr (D == 2) {
    type.def("point", [](const Held<D>& s, const py::object& out, double u, double v) {
      evaluate_one<D>(s, out, {u, v});
    });
  } else {
    type.def("point", [](const Held<D>& s, const py::object& out, double u, double v, double w) {
      evaluate_one<D>(s, out, {u, v, w});
    });
  }
  type.def("inserted", [](const Held<D>& held, const py::sequence& knots) {
    std::array<std::vector<double>, D> lists;
    for (std::size_t d = 0; d < D; ++d) lists[d] = Doubles(knots[d]).vector();
    return inserted<D>(held, lists);
  });
  type.def("elevated", &elevated<D>);
  type.def("without_knots", &without_knots<D>);
  if constexpr (D == 2) type.def("normals", &normals);
  if constexpr (D < 3) {
    type.def("curvatures", [](const Held<D>& held, const py::sequence& at, bool left,
                              const py::object& out) { curvatures(held, at, left, out); });
    const std::string search = std::string(name) + "Search";
    py::class_<ClosestPointSearch<D>>(module, search.c_str()).def("nearest", &nearest<D>);
    type.def("search", [](const Held<D>& held) {
      return value_of(
          without_interpreter([&] { return ClosestPointSearch<D>::create(*held.spline); }));
    });
  }
}

}  // namespace

void bind_spline(py::module_& module) {
  bind<1>(module, "Curve");
  bind<2>(module, "Surface");
  bind<3>(module, "Volume");
}

}  // namespace knead::python
