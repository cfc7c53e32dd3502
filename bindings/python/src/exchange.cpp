#include "binding.hpp"
#include "grids.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"

namespace knead::python {

void bind_exchange(py::module_& module) {
  module.def("formats", &format_json);
  module.def("read_file",
             [](const std::string& path) { return py::bytes(value_of(read_file(path))); });
  module.def("write_file", [](const std::string& path, const py::bytes& bytes) {
    value_of(write_file_atomically(path, std::string_view(bytes)));
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
