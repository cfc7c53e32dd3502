#include "program.hpp"

#include <cstdio>
#include <cstdlib>

#include "binding.hpp"

// What is compiled for programs, as Debian's archive of libpng is, has the address of stderr in it,
// which a shared library cannot know. The linker gives it this one instead (--wrap=stderr).
extern "C" {
extern FILE* __real_stderr;
FILE* __wrap_stderr = nullptr;
[[gnu::constructor(101)]] static void know_stderr() { __wrap_stderr = __real_stderr; }
}

namespace knead::python {

void bind_program(py::module_& module) {
  // Ends the process as the program does: what is at exit is done, the interpreter is not ended.
  module.def("program", [](std::vector<std::string> arguments) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::exit(cli::program(static_cast<int>(arguments.size()), argv.data()));
  });
}

}  // namespace knead::python
