// Solving for three columns with a factor that is kept, beside CHOLMOD's supernodal one: cubic
// sheets of N × N with two rows held, as in contact_bench.
#include <cholmod.h>

#include <Eigen/SparseCore>
#include <cstdlib>

#include "knead/energy/stiffness.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "medians.hpp"
#include "solve/dissection.hpp"
#include "solve/independent_places.hpp"

namespace {

using namespace knead;

/// λ M + K of the unknowns that are free.
SparseMatrix system(int net) {
  const KnotVector k = *KnotVector::clamped_uniform(3, net);
  const SparseMatrix stiffness = Stiffness<2>::create({k, k}, stretch_and_bend<2>({}))->assemble();
  const SparseMatrix mass = Stiffness<2>::create({k, k}, mass_energy<2>())->assemble();
  const SparseMatrix a = stiffness + 20 * mass;
  const int held = 2 * net;
  return a.block(held, held, a.rows() - 2 * held, a.cols() - 2 * held);
}

/// CHOLMOD's factor of a matrix, and its work space.
class Cholmod {
 public:
  explicit Cholmod(const SparseMatrix& a) {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    SparseMatrix lower = a.triangularView<Eigen::Lower>();
    cholmod_sparse view{};
    view.nrow = view.ncol = static_cast<std::size_t>(a.rows());
    view.nzmax = static_cast<std::size_t>(lower.nonZeros());
    view.p = lower.outerIndexPtr();
    view.i = lower.innerIndexPtr();
    view.x = lower.valuePtr();
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    factor_ = cholmod_analyze(&view, &common_);
    cholmod_factorize(&view, factor_, &common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  ~Cholmod() {
    cholmod_free_dense(&x_, &common_);
    cholmod_free_dense(&y_, &common_);
    cholmod_free_dense(&e_, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  const double* solve(Eigen::MatrixXd& b) {
    cholmod_dense view{};
    view.nrow = view.d = static_cast<std::size_t>(b.rows());
    view.ncol = static_cast<std::size_t>(b.cols());
    view.nzmax = view.nrow * view.ncol;
    view.x = b.data();
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(CHOLMOD_A, factor_, &view, nullptr, &x_, nullptr, &y_, &e_, &common_))
      std::abort();
    return static_cast<const double*>(x_->x);
  }

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

void solve(benchmark::State& state) {
  const auto net = static_cast<int>(state.range(0));
  const SparseMatrix a = system(net);
  GridPlaces places{2, {}};  // two lines at each end of the first direction are held
  for (int i = 2 * net; i < 2 * net + a.rows(); ++i)
    places.indices.insert(places.indices.end(), {i / net, i % net});
  // As steps do: large nets are dissected.
  const auto ours = a.rows() < detail::least_dissected
                        ? SparseCholesky::factor(a)
                        : SparseCholesky::factor(SparseMatrix(a), places);
  if (!ours) std::abort();
  Cholmod theirs(a);
  const Points b = Points::Random(a.rows(), 3);
  Eigen::MatrixXd columns = b;
  Points x;
  bench::beside(
      state,
      [&] {
        x = ours->solve(b);
        benchmark::DoNotOptimize(x.data());
      },
      [&] { benchmark::DoNotOptimize(theirs.solve(columns)); }, bench::Ratio::times_faster);
  const Eigen::Map<const Eigen::MatrixXd> reference(theirs.solve(columns), a.rows(), 3);
  if ((reference - x).norm() > 1e-8 * x.norm()) std::abort();
}

BENCHMARK(solve)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

}  // namespace
