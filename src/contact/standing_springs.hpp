#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "knead/contact/active_spline.hpp"
#include "net_operator.hpp"
#include "solve/step_inverse.hpp"
#include "tool/potential.hpp"

namespace knead {

/// A step's operator with springs k/2 |rᵀX − to|² on points in it: A + Σ k r rᵀ, whose inverse
/// serves wherever they draw to. Conjugate gradients on A⁻¹ need about as many substitutions as
/// there are springs.
///
/// A spring in A acts as an implicit one in any case, as Ψ is taken at the new position: the
/// minimum is the same, only the preconditioner is better.
template <int D>
struct SprungSystem {
  std::vector<PointForce> springs;     ///< of these terms and strengths
  NetOperator<D> a;                    ///< A + Σ k r rᵀ
  std::optional<StepInverse> inverse;  ///< none: it is too close to singular
};

/// The last `SprungSystem` of a model. Thread-safe.
template <int D>
class SprungSystems {
 public:
  using System = std::shared_ptr<const SprungSystem<D>>;

  [[nodiscard]] System last() const {
    const Lock lock(busy_);
    return last_;
  }
  void keep(System system) {
    const Lock lock(busy_);
    last_.swap(system);
  }

 private:
  // WebAssembly has no std::mutex; a pointer is copied before anyone waits for long.
  struct Lock {
    explicit Lock(std::atomic_flag& flag) : busy(flag) {
      while (busy.test_and_set(std::memory_order_acquire)) {
      }
    }
    ~Lock() { busy.clear(std::memory_order_release); }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    std::atomic_flag& busy;
  };

  mutable std::atomic_flag busy_;
  System last_;
};

/// The springs that belong to the matrix, in their order: those on points that depend on no more
/// control points than one of the spline does, where there are many. Others couple control points
/// that A does not, and are left to conjugate gradients, as few are. Empty: none.
template <int D>
[[nodiscard]] std::vector<PointForce> standing_springs(std::span<const PointForce> forces,
                                                       std::span<const Spline<D>> patches);
/// Whether a force is one that `standing_springs` may choose.
template <int D>
[[nodiscard]] bool may_stand(const PointForce& force, std::span<const Spline<D>> patches);

/// Whether they make the same matrix: wherever they draw to.
[[nodiscard]] bool same_stiffness(std::span<const PointForce> a, std::span<const PointForce> b);

/// Σ k r rᵀ, both triangles.
[[nodiscard]] SparseMatrix spring_stiffness(int size, std::span<const PointForce> springs);

/// Adds their potential and forces at the control points x, in whose units `to` is.
void add_springs(std::span<const PointForce> springs, const Points& x, PotentialState& state);

}  // namespace knead
