#pragma once

namespace knead::cli {

/// The command line, whoever starts it: the program `knead`, or the Python package within a process
/// of its own. It takes the standard streams for itself. Returns the exit code.
[[nodiscard]] int program(int argc, char** argv);

}  // namespace knead::cli
