#include "studio_material.hpp"

#include "buffers.hpp"

namespace knead::studio {

Expected<MaterialSamples> material_samples(const MaterialFieldOf<2>& material, const Surface& domain_of,
                                           std::array<int, 2> counts) {
  std::array<std::vector<double>, 2> at;
  for (std::size_t d = 0; d < 2; ++d) {
    if (counts[d] < 2 || counts[d] > 1000) {
      return std::unexpected(
          Error{ErrorKind::usage, "a material has 2 to 1000 samples in each direction", "counts", "ask for as many"});
    }
    const Interval domain = domain_of.knots()[d].domain();
    for (int k = 0; k + 1 < counts[d]; ++k) at[d].push_back(domain.lower + domain.length() * k / (counts[d] - 1));
    at[d].push_back(domain.upper);
  }
  const auto sampled = [&](const Coefficient<2>& coefficient) -> Expected<std::vector<double>> {
    if (const auto* field = std::get_if<SplineField<2>>(&coefficient)) return field->on_grid({at[0], at[1]});
    return std::vector<double>(at[0].size() * at[1].size(), std::get<double>(coefficient));
  };
  MaterialSamples samples;
  for (std::size_t k = 0; k < 3; ++k) {
    for (auto [values, coefficient] :
         {std::pair{&samples.alpha[k], &material.alpha[k]}, std::pair{&samples.beta[k], &material.beta[k]}}) {
      auto found = sampled(*coefficient);
      if (!found) return std::unexpected(found.error());
      *values = *std::move(found);
    }
  }
  return samples;
}

std::string material_json(const MaterialSamples& s) {
  return "{\"buffers\":" +
         buffers_json({{"alpha11", s.alpha[0]},
                       {"alpha12", s.alpha[1]},
                       {"alpha22", s.alpha[2]},
                       {"beta11", s.beta[0]},
                       {"beta12", s.beta[1]},
                       {"beta22", s.beta[2]}}) +
         "}";
}

}  // namespace knead::studio
