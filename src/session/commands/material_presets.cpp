#include "material_presets.hpp"

namespace knead {
namespace {

// Figures of docs/clay.md.
constexpr double local = 0.25, half_local = 0.35, wide = 1;  // locality in radii of the tool
const Preset presets[] = {
    {{{0.1, 0, 0.1}, {0.001, 0.001, 0.001}}, 100, {true, 1, 0, local, true}},            // clay
    {{{0.1, 0, 0.1}, {0.001, 0.001, 0.001}}, 100, {true, 0.9, 0.02, half_local, true}},  // wax
    {{{0.1, 0, 0.1}, {0.01, 0.01, 0.01}}, 1, {true, 0, 0, wide, true}},                  // rubber
    {{{0.05, 0, 0.05}, {0.05, 0.05, 0.05}}, 20, {true, 1, 0.15, wide, true}},  // sheet metal
    {{{1, 0, 1}, {0.0001, 0.0001, 0.0001}}, 1, {true, 0, 0, 0, true}},         // cloth
    {{{1, 0, 1}, {0, 0, 0}}, 1, {true, 0, 0, 0, true}},                        // membrane
};

}  // namespace

const Preset& preset_named(MaterialPreset name) { return presets[static_cast<std::size_t>(name)]; }

std::span<const Choice> choices(MaterialPreset) {
  static constexpr Choice list[] = {
      {"clay", MaterialPreset::clay, "local, stays"},
      {"wax", MaterialPreset::wax, "local, springs back a little"},
      {"rubber", MaterialPreset::rubber, "springs back"},
      {"sheet metal", MaterialPreset::sheet_metal, "bends widely, stays past a yield"},
      {"cloth", MaterialPreset::cloth, "is drawn along, springs back"},
      {"membrane", MaterialPreset::membrane, "a soap film, springs back"}};
  return list;
}

std::vector<NamedMaterial> named_materials() {
  std::vector<NamedMaterial> named;
  for (const Choice& choice : choices(MaterialPreset{})) {
    const Material& material = presets[static_cast<std::size_t>(choice.value)].material;
    named.push_back(
        {std::string(choice.name), std::string(choice.help), material.alpha[0], material.beta[0]});
  }
  return named;
}

void describe(NamedMaterial& m, Fields& fields) {
  fields.name("named material", "A material that has a name.");
  fields.add("name", m.name);
  fields.add("help", m.help);
  fields.add("alpha", m.alpha);
  fields.add("beta", m.beta);
}

std::optional<MaterialPreset> preset_of(const SceneSurface& s) {
  for (std::size_t k = 0; k < std::size(presets); ++k) {
    const auto& [material, lambda, plastic] = presets[k];
    MaterialFieldOf<2> field = s.material;
    for (std::size_t i = 0; i < 3; ++i) {
      field.alpha[i] = material.alpha[i];
      field.beta[i] = material.beta[i];
    }
    if (field == s.material && plastic == s.plastic) return static_cast<MaterialPreset>(k);
  }
  return std::nullopt;
}

}  // namespace knead
