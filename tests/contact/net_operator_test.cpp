#include "contact/net_operator.hpp"

#include <gtest/gtest.h>

#include "support/surfaces.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

constexpr int net = 30, size = net * net;

NetOperator<2> operator_on(int patches) {
  const KnotVector knots = *KnotVector::clamped_uniform(3, net);
  NetOperator<2> sum(patches * size);
  for (const Energy<2>& energy :
       {stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}}), mass_energy<2>()}) {
    for (int k = 0; k < patches; ++k)
      sum.add(k * size, 0.5 + k, *Stiffness<2>::create({knots, knots}, energy));
  }
  sum.add_identity(0.25);
  return sum;
}

TEST(NetOperator, BitsOfProductsDoNotDependOnTheNumberOfThreads) {
  for (const int patches : {1, 2, 5, 9}) {
    const NetOperator<2> sum = operator_on(patches);
    const Points x = testing::random_points(patches * size, 3);
    const Points expected = testing::with_threads(1, [&] { return Points(sum * x); });
    for (const int threads : testing::thread_counts) {
      EXPECT_EQ(testing::with_threads(threads, [&] { return Points(sum * x); }), expected)
          << patches << " " << threads;
    }
  }
}

TEST(NetOperator, AppliedIsAssembledTimesVector) {
  const NetOperator<2> sum = operator_on(3);
  const Points x = testing::random_points(3 * size, 4);
  const Points assembled = sum.assemble() * x;
  EXPECT_LE((sum * x - assembled).norm(), 1e-13 * assembled.norm());
}

}  // namespace
}  // namespace knead
