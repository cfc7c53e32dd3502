// Runs in WebAssembly: knot vectors from the standard input, their Gramians to the standard output,
// all as raw numbers.
//   in:  degree, number of knots (32-bit integers), the knots (doubles); repeated
//   out: per knot vector, method and instruction set: diagonals −p … p of 00, 11, 22 and 10
#include <cstdint>
#include <cstdio>
#include <vector>

#include "knead/gramian/gramian.hpp"

using namespace knead;

int main() {
  std::int32_t head[2];
  while (std::fread(head, sizeof head, 1, stdin) == 1) {
    std::vector<double> numbers(static_cast<std::size_t>(head[1]));
    if (std::fread(numbers.data(), sizeof(double), numbers.size(), stdin) != numbers.size())
      return 1;
    const auto knots = KnotVector::create(head[0], std::move(numbers));
    if (!knots) return 2;
    for (const GramianMethod method : {GramianMethod::recurrence, GramianMethod::gauss}) {
      for (const InstructionSet instructions :
           {InstructionSet::scalar, InstructionSet::vector128}) {
        GramianSet set;
        recompute_gramians(*knots, method, set, instructions);
        for (const BandMatrix* matrix : {&set.g00, &set.g11, &set.g22, &set.g10}) {
          for (int s = -knots->degree(); s <= knots->degree(); ++s) {
            const auto diagonal = matrix->diagonal(s);
            std::fwrite(diagonal.data(), sizeof(double), diagonal.size(), stdout);
          }
        }
      }
    }
  }
  return 0;
}
