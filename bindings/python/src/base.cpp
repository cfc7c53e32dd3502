#include "binding.hpp"
#include "knead/base/threads.hpp"
#include "knead/session/session_info.hpp"

namespace knead::python {

void raise(const Error& error) {
  const py::object made = py::module_::import("knead._errors")
                              .attr("made_of")(error_json(error), error.file, error.line);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
  throw py::error_already_set();
}

Points points_of(const Doubles& numbers) {
  return Eigen::Map<const Points>(numbers.span().data(),
                                  static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

void bind_base(py::module_& module) {
  py::class_<View>(module, "View", py::buffer_protocol()).def_buffer([](View& view) {
    std::vector<py::ssize_t> strides(view.shape.size());
    py::ssize_t stride = view.itemsize;
    for (std::size_t k = strides.size(); k-- > 0; stride *= view.shape[k]) strides[k] = stride;
    return py::buffer_info(const_cast<void*>(view.data), view.itemsize, view.format,
                           static_cast<py::ssize_t>(view.shape.size()), view.shape, strides,
                           view.readonly);
  });
  module.def("set_thread_count", &set_thread_count);
  module.def("thread_count", &thread_count);
}

}  // namespace knead::python
