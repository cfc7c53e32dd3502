#include "binding.hpp"
#include "grids.hpp"
#include "knead/exchange/file_io.hpp"

namespace knead::python {

void bind_exchange(py::module_& module) {
  module.def("read_file", [](const std::string& path) {
    return py::bytes(value_of(without_interpreter([&] { return read_file(path); })));
  });
  module.def("write_file", [](const std::string& path, const py::bytes& bytes) {
    const std::string_view text = bytes;
    value_of(without_interpreter([&] { return write_file_atomically(path, text); }));
  });
  py::class_<Grids>(module, "Grids")
      .def("vtu", [](const Grids& grids) { return vtu_text(*grids.list); })
      .def("arrays", [](const Grids& grids) {
        py::list result;
        for (const FieldGrid& grid : *grids.list) {
          const py::ssize_t m = grid.counts[0], n = grid.counts[1];
          py::list fields;
          for (const GridField& field : grid.fields) {
            fields.append(py::make_tuple(
                field.name, view_of(grids.list, field.values.data(), {m, n, field.components})));
          }
          result.append(py::make_tuple(grid.name,
                                       view_of(grids.list, grid.points.data(), {m, n, 3}), fields));
        }
        return result;
      });
}

}  // namespace knead::python
