// The material of a surface.
#include "knead/energy/material_field.hpp"
#include "query.hpp"

namespace knead::studio {
namespace {

/// The coefficients of a material as values on a grid over the domain, v fastest.
struct MaterialSamples {
  std::array<int, 2> counts = {0, 0};
  std::array<Doubles, 3> alpha, beta;  ///< 11, 12, 22
};

void describe(MaterialSamples& m, Fields& fields) {
  fields.name("material samples",
              "A material by samples over the domain: (i, j) is sample i counts[1] + j, at "
              "fractions i / (counts[0] - 1), j / (counts[1] - 1).");
  fields.add("counts", m.counts);
  fields.add("alpha11", m.alpha[0]);
  fields.add("alpha12", m.alpha[1]);
  fields.add("alpha22", m.alpha[2]);
  fields.add("beta11", m.beta[0]);
  fields.add("beta12", m.beta[1]);
  fields.add("beta22", m.beta[2]);
}

struct MaterialQuery {
  using Answer = MaterialSamples;
  int surface = 0;
  std::array<int, 2> counts = {2, 2};
};

void describe(MaterialQuery& q, Fields& fields) {
  fields.name("material", "The material of a surface as it is now.");
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
  fields.add("counts", q.counts,
             {.help = "samples in each direction, 2 to 1000, with the ends of the domain",
              .presence = Presence::required});
}

Expected<MaterialSamples> ask(Session& session, const MaterialQuery& q) {
  const auto of = surface_of(session, q.surface);
  if (!of) return std::unexpected(of.error());
  const SceneSurface& s = **of;
  std::array<std::vector<double>, 2> at;
  for (std::size_t d = 0; d < 2; ++d) {
    if (q.counts[d] < 2 || q.counts[d] > 1000) {
      return usage_error("a material has 2 to 1000 samples in each direction", "counts",
                         "ask for as many");
    }
    const Interval domain = s.reference->knots()[d].domain();
    for (int k = 0; k + 1 < q.counts[d]; ++k)
      at[d].push_back(domain.lower + domain.length() * k / (q.counts[d] - 1));
    at[d].push_back(domain.upper);
  }
  const auto sampled = [&](const Coefficient<2>& coefficient) -> Expected<std::vector<double>> {
    if (const auto* field = std::get_if<SplineField<2>>(&coefficient))
      return field->on_grid({at[0], at[1]});
    return std::vector<double>(at[0].size() * at[1].size(), std::get<double>(coefficient));
  };
  MaterialSamples samples;
  samples.counts = q.counts;
  for (std::size_t k = 0; k < 3; ++k) {
    for (auto [values, coefficient] : {std::pair{&samples.alpha[k], &s.material.alpha[k]},
                                       std::pair{&samples.beta[k], &s.material.beta[k]}}) {
      auto found = sampled(*coefficient);
      if (!found) return std::unexpected(found.error());
      values->data = *std::move(found);
    }
  }
  return samples;
}

}  // namespace

std::vector<Query> material_queries() { return {query<MaterialQuery>()}; }

}  // namespace knead::studio
