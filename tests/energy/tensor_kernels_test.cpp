#include "energy/simd/tensor_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "knead/energy/stiffness.hpp"

namespace knead {
namespace {

TEST(TensorKernels, GiveTheSameBitsByEveryInstructionSet) {
  constexpr std::ptrdiff_t length = 77, count = 5, spare = detail::TensorKernels::spare, most = 7;
  const Eigen::VectorXd x = Eigen::VectorXd::Random(most * (count + 1) * (length + 3)),
                        f = Eigen::VectorXd::Random(count * length);
  const auto& reference = detail::tensor_kernels(InstructionSet::vector128);
  for (const InstructionSet set : available_instruction_sets()) {
    const auto& kernels = detail::tensor_kernels(set);
    for (std::ptrdiff_t lines = 1; lines <= most; ++lines) {
      constexpr std::ptrdiff_t apart = length + 2;
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(most * apart), y = expected;
      reference.combine(x.data(), length, f.data(), lines, count, length, expected.data(), apart);
      kernels.combine(x.data(), length, f.data(), lines, count, length, y.data(), apart);
      EXPECT_EQ(y, expected) << name(set) << lines;
      double sum = 0, more = expected[(lines - 1) * apart + 70];
      for (std::ptrdiff_t k = 0; k < count; ++k)
        sum += f[k * lines + lines - 1] * x[k * length + 70];
      EXPECT_EQ(more, sum);
      EXPECT_EQ(expected[lines * apart - 1], 0);  // nothing between lines
    }
    for (const std::ptrdiff_t run : {1, 3, 7, 11, 15, 41}) {
      for (const std::ptrdiff_t kinds : {1, 3, 5, 7}) {
        const std::ptrdiff_t columns = 4, rows = 3, values = rows * columns * run;
        Eigen::VectorXd runs = Eigen::VectorXd::Zero(values + spare), written = runs;
        reference.write_runs(x.data(), 45, 7, rows, f.data(), kinds, columns, run, runs.data());
        kernels.write_runs(x.data(), 45, 7, rows, f.data(), kinds, columns, run, written.data());
        EXPECT_EQ(written.head(values), runs.head(values)) << name(set) << run << kinds;
        for (std::ptrdiff_t row = 0; row < rows; ++row) {
          for (std::ptrdiff_t c = 0; c < run; ++c) {
            double sum = 0;
            for (std::ptrdiff_t g = 0; g < kinds; ++g)
              sum += f[3 * kinds + g] * x[g * 45 + 7 * row + c];
            EXPECT_EQ(runs[(columns * row + 3) * run + c], sum);
          }
        }
      }
    }
  }
}

TEST(TensorKernels, ApplyBandsToLinesInSegments) {
  using Lines = std::vector<double, CacheLineAllocator<double>>;
  constexpr std::ptrdiff_t kinds = 2, lines = 3, most = 60;
  const Eigen::VectorXd x = Eigen::VectorXd::Random(kinds * lines * 3 * most),
                        f = Eigen::VectorXd::Random(kinds * most * 11),
                        before = Eigen::VectorXd::Random(lines * most * 3);
  for (const InstructionSet set : available_instruction_sets()) {
    const auto& kernels = detail::tensor_kernels(set);
    const std::ptrdiff_t lanes = kernels.lanes;
    for (const std::ptrdiff_t size : {1, 5, 8, 16, 23, 32, 60}) {
      for (const std::ptrdiff_t p : {0, 1, 2, 3, 5}) {
        const std::ptrdiff_t points = (size + lanes - 1) / lanes, line = 3 * points * lanes,
                             padded = line + 6 * p * lanes;
        // Entry (i, i + k − p) of matrix g; number (l, i, c) of kind g.
        const auto entry = [&](std::ptrdiff_t g, std::ptrdiff_t i, std::ptrdiff_t k) {
          return i + k < p || i + k - p >= size ? 0.0 : f[(g * most + i) * 11 + k];
        };
        const auto number = [&](std::ptrdiff_t g, std::ptrdiff_t l) {
          return x.data() + (g * lines + l) * 3 * most;
        };
        Lines padded_x(static_cast<std::size_t>(kinds * lines * padded), -1),
            y(static_cast<std::size_t>(lines * line));
        Lines whole(static_cast<std::size_t>(line)), back(whole), bands[kinds];
        const double* all[kinds];
        for (std::ptrdiff_t g = 0; g < kinds; ++g) {
          for (std::ptrdiff_t l = 0; l < lines; ++l) {
            std::ranges::fill(std::copy_n(number(g, l), 3 * size, whole.begin()), whole.end(), 0);
            double* to = padded_x.data() + (g * lines + l) * padded + 3 * p * lanes;
            kernels.to_segments(whole.data(), 3 * points, to);
            kernels.from_segments(to, 3 * points, back.data());
            EXPECT_EQ(whole, back);
            kernels.surround(to, points, p);
          }
          bands[g].resize(static_cast<std::size_t>((2 * p + 1) * points * lanes));
          all[g] = bands[g].data();
          for (std::ptrdiff_t i = 0; i < size; ++i) {
            double* to = bands[g].data() + i % points * (2 * p + 1) * lanes + i / points;
            for (std::ptrdiff_t k = 0; k <= 2 * p; ++k) to[k * lanes] = entry(g, i, k);
          }
        }
        for (std::ptrdiff_t l = 0; l < lines; ++l) {
          std::ranges::fill(std::copy_n(before.data() + l * 3 * size, 3 * size, whole.begin()),
                            whole.end(), 0);
          kernels.to_segments(whole.data(), 3 * points, y.data() + l * line);
        }
        for (const bool from_zero : {false, true}) {
          kernels.add_bands(all, kinds, p, points, padded_x.data() + 3 * p * lanes, lines * padded,
                            padded, lines, from_zero, y.data(), line);
          for (std::ptrdiff_t l = 0; l < lines; ++l) {
            kernels.from_segments(y.data() + l * line, 3 * points, back.data());
            for (std::ptrdiff_t m = 0; m < 3 * size; ++m) {
              double sum = from_zero ? 0 : before[l * 3 * size + m];
              for (std::ptrdiff_t g = 0; g < kinds; ++g) {
                for (std::ptrdiff_t k = 0; k <= 2 * p; ++k) {
                  if (const double e = entry(g, m / 3, k); e != 0)
                    sum += e * number(g, l)[m + 3 * (k - p)];
                }
              }
              EXPECT_EQ(back[static_cast<std::size_t>(m)], sum) << name(set) << size << p << m;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace knead
