#pragma once

#include <unordered_set>

#include "describe/cbor.hpp"
#include "describe/describe.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

// Described values as CBOR, each by what differs from another one of its type: from the value
// before it, or from the initial value of its type. What is not written is as it was there, so that
// a new field is a default to older bytes.

/// A pointer to a spline; values with the same one share it again when they are read.
template <int D>
using SplinePointer = std::shared_ptr<const Spline<D>>;

struct KnotForm {
  int degree = 0;
  std::vector<double> knots;
};
/// A spline as it is written.
struct SplineForm {
  std::vector<KnotForm> knots;
  Points points;
  std::vector<double> weights;
};
void describe(KnotForm& k, Fields& fields);
void describe(SplineForm& s, Fields& fields);

template <int D>
[[nodiscard]] std::vector<KnotForm> form_of(const std::array<KnotVector, D>& knots) {
  std::vector<KnotForm> form;
  for (const KnotVector& k : knots)
    form.push_back({k.degree(), {k.knots().begin(), k.knots().end()}});
  return form;
}
/// Nothing if these are no knots of so many directions.
template <int D>
[[nodiscard]] std::optional<std::array<KnotVector, D>> knots_of(std::vector<KnotForm>&& form);

/// Whether two values are the same to the last bit in all that is described; splines are if they
/// are shared, or with `deep` if their numbers are.
[[nodiscard]] bool same(const Type& type, const void* a, const void* b, bool deep = false);

/// Whether all numbers of a value, at any depth, are finite.
[[nodiscard]] bool all_finite(const Type& type, const void* value);

/// Bytes of memory that copies of values take besides themselves. What copies share is counted
/// once.
class Weight {
 public:
  [[nodiscard]] std::size_t of(const Type& type, const void* value);

 private:
  [[nodiscard]] std::size_t of_shared(const Type& list, const void* value);
  std::unordered_set<const void*> seen_;
};

class StateWriter : public cbor::Writer {
 public:
  using Writer::Writer;

  /// Writes a value as far as it differs from the other one. Records are maps of those fields,
  /// variants a map of the name to the record, choices their names. Numbers, and lists of nothing
  /// else, keep their bits: as byte strings, little-endian. Other lists are an array: how many
  /// elements are the same at the beginning, then each further one, undefined if it is the same as
  /// the other one's there. A spline is written once, and the k-th is k afterwards.
  void write(const Type& type, const void* value, const void* other);

 private:
  void write_list(const Type& type, const void* value, const void* other);
  void write_opaque(const Type& type, const void* value, const void* other);
  template <int D>
  void write_spline(const Spline<D>& spline);
  std::unordered_map<const void*, std::size_t> splines_;
};

class StateReader : public cbor::Reader {
 public:
  /// It becomes bad where the values need more than so many bytes of memory.
  StateReader(std::string_view bytes, std::size_t memory) : Reader(bytes), memory_(memory) {}

  /// Reads what `write` wrote into the value that was the other one. Unknown names, and pointers
  /// left null, make it bad.
  void read(const Type& type, void* value);
  /// Counts memory.
  void takes_memory(std::size_t size) {
    if (size > memory_) fail();
    memory_ -= std::min(size, memory_);
  }

 private:
  void read_list(const Type& type, void* value);
  void read_record(const Type& type, void* value);
  void read_opaque(const Type& type, void* value);
  template <int D>
  void read_spline(SplinePointer<D>& spline);
  std::vector<std::pair<int, std::shared_ptr<const void>>> splines_;  // with their directions
  std::size_t memory_;
};

namespace detail {

template <int N>
struct TypeMaker<Eigen::Matrix<double, Eigen::Dynamic, N, Eigen::RowMajor>> {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, N, Eigen::RowMajor>;
  static Type make() {
    return {.kind = Kind::list,
            .element = &type_of<std::array<double, N>>(),
            .count = [](const void* v) { return static_cast<std::size_t>(as<Rows>(v).rows()); },
            .resize = [](void* v,
                         std::size_t n) { as<Rows>(v).resize(static_cast<Eigen::Index>(n), N); },
            .at = [](void* v, std::size_t k) -> void* { return as<Rows>(v).data() + N * k; },
            .weight = N * sizeof(double)};
  }
};

}  // namespace detail
}  // namespace knead
