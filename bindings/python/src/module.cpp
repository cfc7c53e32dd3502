#include "binding.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace knead::python;
  module.doc() = "The library of Knead, for the package knead alone: types in, types out.";
  module.attr("version") = KNEAD_VERSION;
  bind_base(module);
  bind_spline(module);
  bind_gramian(module);
  bind_contact(module);
  bind_image(module);
  bind_exchange(module);
  bind_session(module);
  bind_program(module);
}
