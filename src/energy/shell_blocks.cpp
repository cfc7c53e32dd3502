#include "shell_blocks.hpp"

#include <algorithm>

#include "base/parallel_for.hpp"
#include "knead/base/instruction_set.hpp"
#include "knead/base/threads.hpp"

namespace knead::detail {
namespace {

const ShellKernels& fastest_shell_kernels() {
  const bool wide = avx2_shell_kernels != nullptr && best_instruction_set() >= InstructionSet::avx2;
  return wide ? *avx2_shell_kernels : *vector128_shell_kernels;
}

std::size_t lanewise(std::ptrdiff_t numbers) {
  return static_cast<std::size_t>(ShellBlockShape::lanes * numbers);
}

}  // namespace

// The unit of work is a block of four elements whose numbers lie side by side, number k of element
// l at `lanes` · k + l: one vector instruction does the same to four elements, whatever the degree,
// with no shuffles and no remainders inside of an element. The last block repeats its last element
// with weights of zero. A block has the one-dimensional basis tables of both directions, (p + 1)
// numbers per point each, from which kernels form the tensor products: tables of all functions at
// all points would be that squared.
ShellBlocks::ShellBlocks(const Surface& surface, const std::array<BasisQuadrature, 2>& quadrature,
                         const std::array<int, 2>& points,
                         const std::vector<ShellElement>& elements, std::vector<ShellRest>& rest)
    : shape_{{quadrature[0].basis.degree + 1, quadrature[1].basis.degree + 1},
             {points[0], points[1]},
             surface.rational()},
      kernels_(&fastest_shell_kernels()),
      spans_(quadrature[1].basis.size() / points[1]) {
  for (const ShellElement& element : elements)
    nodes_.insert(nodes_.end(), element.nodes.begin(), element.nodes.end());
  const auto total = static_cast<int>(elements.size());
  for (int first = 0; first < total; first += lanes) {
    Block block;
    block.count = std::min(lanes, total - first);
    for (int l = 0; l < lanes; ++l)
      block.element[static_cast<std::size_t>(l)] = std::min(first + l, total - 1);
    pack_tables(block, quadrature);
    if (shape_.rational) pack_weights(block, surface, quadrature);
    blocks_.push_back(std::move(block));
  }
  measure_rest(surface.control_points(), rest);
  for (Block& block : blocks_) pack_rest(block, rest);
}

/// Against forms of zero and with a stiffness of one the stresses are half the metric and minus the
/// curvature.
/// They are taken from the kernels themselves and not from `ShellPoint`, whose sums are in another
/// order: differences by rounding would leave strains at rest.
void ShellBlocks::measure_rest(const Points& x, std::vector<ShellRest>& rest) {
  const ShellRest unit{0,
                       0,
                       0,
                       Eigen::Vector3d::Zero(),
                       Eigen::Vector3d::Zero(),
                       Eigen::Matrix3d::Identity(),
                       Eigen::Matrix3d::Identity()};
  const std::vector<ShellRest> units(rest.size(), unit);
  for (Block& block : blocks_) pack_rest(block, units);
  ShellStress forms(6, static_cast<Eigen::Index>(rest.size()));
  static_cast<void>(forces(x, nullptr, &forms));
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const auto form = forms.col(static_cast<Eigen::Index>(k));
    rest[k].metric << 2 * form[0], 2 * form[1], form[2];
    rest[k].curvature << -form[3], -form[4], -form[5] / 2;
  }
}

void ShellBlocks::pack_tables(Block& block,
                              const std::array<BasisQuadrature, 2>& quadrature) const {
  for (std::size_t d = 0; d < 2; ++d) {
    const std::ptrdiff_t numbers = 3 * shape_.points[d] * shape_.functions[d];
    block.table[d].resize(lanewise(numbers));
    for (std::size_t l = 0; l < lanes; ++l) {
      const int span = d == 0 ? block.element[l] / spans_ : block.element[l] % spans_;
      const double* from = quadrature[d].basis.row(span * static_cast<int>(shape_.points[d]), 0);
      for (std::ptrdiff_t k = 0; k < numbers; ++k) block.table[d][lanewise(k) + l] = from[k];
    }
  }
}

void ShellBlocks::pack_rest(Block& block, const std::vector<ShellRest>& rest) const {
  block.rest.resize(lanewise(ShellBlockShape::rest_numbers * shape_.gauss()));
  double* to = block.rest.data();
  for (std::ptrdiff_t k = 0; k < shape_.gauss(); ++k) {
    for (int l = 0; l < lanes; ++l) {
      const std::ptrdiff_t at = block.element[static_cast<std::size_t>(l)] * shape_.gauss() + k;
      const ShellRest& r = rest[static_cast<std::size_t>(at)];
      double* number = to + l;
      const auto put = [&](double value) {
        *number = value;
        number += lanes;
      };
      put(l < block.count ? r.weight : 0);
      for (int c = 0; c < 3; ++c) put(r.metric[c]);
      for (int c = 0; c < 3; ++c) put(r.curvature[c]);
      for (const Eigen::Matrix3d* m : {&r.membrane, &r.bending}) {
        for (int c = 0; c < 3; ++c) {
          for (int e = c; e < 3; ++e) put((*m)(c, e));
        }
      }
    }
    to += lanes * ShellBlockShape::rest_numbers;
  }
}

/// With W = Σ w N at every point: 1/W and by what the numerator p contributes to S_u, S_v, S_uu,
/// S_vv, S_uv.
/// R = w N / W, so that S = A / W with the numerator A = Σ w N x. The kernels sum derivatives of A
/// as for a polynomial surface and combine them:
///   S_u  = c A_u + c_u A,                        c = 1/W, c_u = −c² W_u,
///   S_uu = c A_uu + 2 c_u A_u + c_uu A,          c_uu = c² (2 c W_u² − W_uu),
/// and likewise for v and uv: six numbers per point in place of tables of rational functions.
void ShellBlocks::pack_weights(Block& block, const Surface& surface,
                               const std::array<BasisQuadrature, 2>& quadrature) const {
  block.weight.resize(lanewise(shape_.local()));
  block.quotient.resize(lanewise(ShellBlockShape::quotient_numbers * shape_.gauss()));
  for (std::size_t l = 0; l < lanes; ++l) {
    const int* node = nodes(block.element[l]);
    for (std::ptrdiff_t r = 0; r < shape_.local(); ++r) {
      block.weight[lanewise(r) + l] = surface.weights()[static_cast<std::size_t>(node[r])];
    }
    const int first[2] = {block.element[l] / spans_ * static_cast<int>(shape_.points[0]),
                          block.element[l] % spans_ * static_cast<int>(shape_.points[1])};
    for (std::ptrdiff_t k = 0; k < shape_.gauss(); ++k) {
      const int u = first[0] + static_cast<int>(k / shape_.points[1]);
      const int v = first[1] + static_cast<int>(k % shape_.points[1]);
      const auto sum = [&](int a, int b) {
        double total = 0;
        for (std::ptrdiff_t r = 0; r < shape_.local(); ++r) {
          total += block.weight[lanewise(r) + l] *
                   quadrature[0].basis.row(u, a)[r / shape_.functions[1]] *
                   quadrature[1].basis.row(v, b)[r % shape_.functions[1]];
        }
        return total;
      };
      const double c = 1 / sum(0, 0), wu = sum(1, 0), wv = sum(0, 1);
      const double numbers[] = {c,
                                -c * c * wu,
                                -c * c * wv,
                                c * c * (2 * c * wu * wu - sum(2, 0)),
                                c * c * (2 * c * wv * wv - sum(0, 2)),
                                c * c * (2 * c * wu * wv - sum(1, 1))};
      for (std::ptrdiff_t n = 0; n < ShellBlockShape::quotient_numbers; ++n) {
        block.quotient[lanewise(ShellBlockShape::quotient_numbers * k + n) + l] = numbers[n];
      }
    }
  }
}

ShellBlockData ShellBlocks::data(const Block& block) {
  return {{block.table[0].data(), block.table[1].data()}, block.rest.data(), block.quotient.data()};
}

void ShellBlocks::gather(const Block& block, const Points& x, std::vector<double>& to) const {
  for (std::size_t l = 0; l < lanes; ++l) {
    const int* node = nodes(block.element[l]);
    for (std::ptrdiff_t r = 0; r < shape_.local(); ++r) {
      const double weight = shape_.rational ? block.weight[lanewise(r) + l] : 1;
      for (std::ptrdiff_t c = 0; c < 3; ++c) to[lanewise(3 * r + c) + l] = weight * x(node[r], c);
    }
  }
}

ShellParts ShellBlocks::forces(const Points& x, Eigen::Ref<Points>* gradient,
                               ShellStress* stress) const {
  std::vector<double> here(lanewise(3 * shape_.local())), force(here.size()),
      work(static_cast<std::size_t>(shape_.work())), resultants(lanewise(6 * shape_.gauss()));
  std::array<double, 2 * lanes> parts{};
  for (const Block& block : blocks_) {
    gather(block, x, here);
    kernels_->forces(shape_, data(block), here.data(), work.data(), parts.data(),
                     gradient != nullptr ? force.data() : nullptr,
                     stress != nullptr ? resultants.data() : nullptr);
    for (std::size_t l = 0; l < static_cast<std::size_t>(block.count); ++l) {
      const int* node = nodes(block.element[l]);
      for (std::ptrdiff_t r = 0; gradient != nullptr && r < shape_.local(); ++r) {
        const double weight = shape_.rational ? block.weight[lanewise(r) + l] : 1;
        for (std::ptrdiff_t c = 0; c < 3; ++c)
          (*gradient)(node[r], c) += weight * force[lanewise(3 * r + c) + l];
      }
      for (std::ptrdiff_t k = 0; stress != nullptr && k < shape_.gauss(); ++k) {
        for (std::ptrdiff_t c = 0; c < 6; ++c) {
          (*stress)(c, block.element[l] * shape_.gauss() + k) = resultants[lanewise(6 * k + c) + l];
        }
      }
    }
  }
  ShellParts sum;
  for (std::size_t l = 0; l < lanes; ++l) {
    sum.membrane += parts[l];
    sum.bending += parts[lanes + l];
  }
  return sum;
}

/// Adds blocks of 3 × 3 to a matrix, both a block and its mirror image.
class ShellBlockSum {
 public:
  ShellBlockSum(const TensorPattern<2>& pattern, const SparseMatrix& scalar, SparseMatrix& matrix)
      : pattern_(pattern), start_(scalar.outerIndexPtr()), value_(matrix.valuePtr()) {}

  void add(int a, int b, const std::array<double, 9>& block) {
    double* to = at(a, b);
    const std::ptrdiff_t step = 3 * (start_[a + 1] - start_[a]);
    for (std::ptrdiff_t c = 0; c < 3; ++c) {
      for (std::ptrdiff_t e = 0; e < 3; ++e)
        to[c * step + e] += block[static_cast<std::size_t>(3 * c + e)];
    }
  }

 private:
  [[nodiscard]] double* at(int a, int b) const {
    return value_ + 9 * static_cast<std::ptrdiff_t>(start_[a]) +
           3 * pattern_.offset(pattern_.unpack(a), pattern_.unpack(b));
  }

  const TensorPattern<2>& pattern_;
  const int* start_;
  double* value_;
};

std::size_t ShellBlocks::hessian_numbers() const {
  return lanewise(9 * shape_.functions[0] * shape_.functions[0] * shape_.pairs());
}

void ShellBlocks::find_hessians(std::span<const Block> blocks, const Points& x,
                                const ShellStress& stress, double* to) const {
  std::vector<double> here(lanewise(3 * shape_.local())),
      work(static_cast<std::size_t>(shape_.work())), resultants(lanewise(6 * shape_.gauss()));
  for (const Block& block : blocks) {
    gather(block, x, here);
    for (std::size_t l = 0; l < lanes; ++l) {
      for (std::ptrdiff_t k = 0; k < 6 * shape_.gauss(); ++k) {
        resultants[lanewise(k) + l] = stress.data()[block.element[l] * 6 * shape_.gauss() + k];
      }
    }
    kernels_->hessian(shape_, data(block), here.data(), resultants.data(), work.data(), to);
    to += hessian_numbers();
  }
}

template <class Owns>
void ShellBlocks::add_entries(const Block& block, const double* numbers, const Owns& owns,
                              ShellBlockSum& sum) const {
  const std::ptrdiff_t p = shape_.functions[0], q = shape_.functions[1];
  for (std::size_t l = 0; l < static_cast<std::size_t>(block.count); ++l) {
    const int* node = nodes(block.element[l]);
    const auto weight = [&](std::ptrdiff_t r) {
      return shape_.rational ? block.weight[lanewise(r) + l] : 1;
    };
    for (std::ptrdiff_t j = 0; j < q; ++j) {
      for (std::ptrdiff_t k = j; k < q; ++k) {
        if (!owns(node[j]) && !owns(node[k])) continue;
        for (std::ptrdiff_t i = 0; i < p; ++i) {
          // Kernels give each pair of functions once; its mirror image is added at the same time,
          // so that the matrix is symmetric to the last bit and needs no pass of its own.
          for (std::ptrdiff_t n = j == k ? i : 0; n < p; ++n) {
            const double* from = numbers + lanewise(9 * ((shape_.pair(j, k) * p + i) * p + n)) + l;
            const std::ptrdiff_t a = i * q + j, b = n * q + k;
            const double w = weight(a) * weight(b);
            std::array<double, 9> here_there, there_here;
            for (std::size_t c = 0; c < 3; ++c) {
              for (std::size_t e = 0; e < 3; ++e) {
                // Symmetric to the last bit.
                const std::size_t number = a == b && e < c ? 3 * e + c : 3 * c + e;
                here_there[3 * c + e] = there_here[3 * e + c] = w * from[lanes * number];
              }
            }
            if (owns(node[j])) sum.add(node[a], node[b], here_there);
            if (a != b && owns(node[k])) sum.add(node[b], node[a], there_here);
          }
        }
      }
    }
  }
}

void ShellBlocks::add_hessian(const Points& x, const ShellStress& stress,
                              const TensorPattern<2>& pattern, const SparseMatrix& scalar,
                              SparseMatrix& matrix) const {
  const std::span<const Block> all = blocks_;
  const bool shared = thread_count() > 1 && all.size() >= 8;
  // Some blocks at a time: their numbers, by all threads; then the sums, each thread those of some
  // rows of the matrix (of a share of the second direction), so that every entry is summed up in
  // the order of the elements.
  const std::size_t together = shared ? 32 : 1;
  const std::ptrdiff_t shares = shared ? std::min(4, pattern.net[1]) : 1;
  std::vector<double> numbers(std::min(together, all.size()) * hessian_numbers());
  ShellBlockSum sum(pattern, scalar, matrix);
  for (std::size_t first = 0; first < all.size(); first += together) {
    const std::span<const Block> some = all.subspan(first, std::min(together, all.size() - first));
    parallel_for(std::ssize(some), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      find_hessians(
          some.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)), x,
          stress, numbers.data() + static_cast<std::size_t>(begin) * hessian_numbers());
    });
    parallel_for(shares, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const auto n = static_cast<std::ptrdiff_t>(pattern.net[1]), from = begin * n / shares,
                 to = end * n / shares;
      const auto owns = [&](int node) { return from <= node % n && node % n < to; };
      const auto every = [](int) { return true; };
      for (std::size_t k = 0; k < some.size(); ++k) {
        const double* local = numbers.data() + k * hessian_numbers();
        if (end - begin == shares) {
          add_entries(some[k], local, every, sum);
        } else {
          add_entries(some[k], local, owns, sum);
        }
      }
    });
  }
}

}  // namespace knead::detail
