#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace knead::house {

/// A function's first line (from 1) and its number of lines, from its head to its closing brace.
struct FunctionLength {
  std::size_t line, lines;
  std::string head;
};

/// The functions of a C++ source, given line by line without comments and literals. Lambdas and
/// local types count to the function they are in. A counter of braces and no parser: a block
/// belongs to a function where what stands before it has parentheses and names no type or
/// namespace.
[[nodiscard]] std::vector<FunctionLength> function_lengths(const std::vector<std::string>& code);

}  // namespace knead::house
