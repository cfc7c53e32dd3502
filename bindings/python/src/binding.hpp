#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

// What the files of the module share: values in, values out. The package's Python has checked types
// and shapes, and calls nothing here with others.
namespace knead::python {

namespace py = pybind11;

/// Raises the `knead.Error` of an error, which the package's Python makes.
[[noreturn]] void raise(const Error& error);

template <class T>
T value_of(Expected<T> expected) {
  if (!expected) raise(expected.error());
  if constexpr (!std::is_void_v<T>) return *std::move(expected);
}

/// Does this while others have the interpreter: it must not touch Python.
template <class Act>
auto without_interpreter(Act&& act) {
  const py::gil_scoped_release others;
  return act();
}

/// C-contiguous numbers of an array of Python, which stays as it is until this goes.
template <class T>
class Numbers {
 public:
  explicit Numbers(py::handle array, bool writable = false) {
    const int flags = PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | (writable ? PyBUF_WRITABLE : 0);
    if (PyObject_GetBuffer(array.ptr(), &view_, flags) != 0) throw py::error_already_set();
    if (view_.itemsize == sizeof(T) && py::format_descriptor<T>::format() == view_.format) return;
    PyBuffer_Release(&view_);
    throw py::type_error("an array of other numbers");
  }
  Numbers(Numbers&& other) noexcept : view_(std::exchange(other.view_, {})) {}
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;
  Numbers& operator=(Numbers&&) = delete;
  ~Numbers() {
    if (view_.obj != nullptr) PyBuffer_Release(&view_);
  }

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(view_.len) / sizeof(T); }
  [[nodiscard]] std::span<T> span() const { return {static_cast<T*>(view_.buf), size()}; }
  [[nodiscard]] std::vector<T> vector() const { return {span().begin(), span().end()}; }
  [[nodiscard]] py::ssize_t extent(int axis) const { return view_.shape[axis]; }

 private:
  Py_buffer view_{};
};
using Doubles = Numbers<double>;

/// N × 3 coordinates.
[[nodiscard]] Points points_of(const Doubles& numbers);

/// Memory of the library as an array of Python: by the buffer protocol, without a copy. It lives as
/// long as the array.
struct View {
  std::shared_ptr<const void> owner;
  const void* data = nullptr;
  std::string format;
  py::ssize_t itemsize = 0;
  std::vector<py::ssize_t> shape;
  bool readonly = true;
};

/// What nobody else knows: it may be written to. Empty memory is a valid address all the same.
template <class T>
[[nodiscard]] View view_of(std::shared_ptr<const void> owner, const T* data,
                           std::vector<py::ssize_t> shape, bool readonly = true) {
  static constexpr T none{};
  return {std::move(owner),
          data != nullptr ? data : &none,
          py::format_descriptor<T>::format(),
          sizeof(T),
          std::move(shape),
          readonly};
}
/// Of a list or matrix that is given away.
template <class List>
[[nodiscard]] View view_of_own(List list, std::vector<py::ssize_t> shape) {
  const auto kept = std::make_shared<List>(std::move(list));
  return view_of(kept, kept->data(), std::move(shape), false);
}

/// A spline as Python holds it: immutable, shared.
template <int D>
struct Held {
  std::shared_ptr<const Spline<D>> spline;
};

void bind_base(py::module_& module);
void bind_spline(py::module_& module);
void bind_gramian(py::module_& module);
void bind_contact(py::module_& module);
void bind_image(py::module_& module);
void bind_exchange(py::module_& module);
void bind_session(py::module_& module);
void bind_program(py::module_& module);

}  // namespace knead::python
