#include "knead/exchange/step_file.hpp"

#include <algorithm>
#include <charconv>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/source.hpp"
#include "part21_text.hpp"
#include "step_data.hpp"
#include "step_entity.hpp"
#include "step_faces.hpp"
#include "step_free_curves.hpp"
#include "step_instances.hpp"
#include "step_share.hpp"
#include "step_surfaces.hpp"
#include "step_trimming.hpp"
#include "step_units.hpp"

namespace knead::step {
namespace {

std::string schema_of(const Part21File& file) {
  const Reader reader(file);
  for (const auto record : file.header()) {
    if (!same_keyword(file.keyword(record), "FILE_SCHEMA")) continue;
    const auto parameters = file.children(record);
    if (parameters.empty() || !reader.is_list(parameters[0])) return {};
    const auto names = file.children(parameters[0]);
    if (names.empty()) return {};
    // "AUTOMOTIVE_DESIGN { 1 0 10303 214 … }": the object identifier is not part of the name.
    const auto name = reader.string(names[0]);
    return name.substr(0, name.find_first_of(" {"));
  }
  return {};
}

}  // namespace

Expected<File> File::read(const std::filesystem::path& path) {
  auto bytes = read_file(path);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return parse(*std::move(bytes), path.string());
}

Expected<File> File::parse(std::string bytes, std::string name) {
  auto records = Part21File::parse(std::move(bytes), std::move(name));
  if (!records) return std::unexpected(std::move(records.error()));
  auto data = std::make_shared<Data>(*std::move(records));
  const Reader reader(data->records);
  data->schema = schema_of(data->records);
  if (auto few = check_loop_uses(reader); !few) return std::unexpected(std::move(few.error()));

  const auto instances = b_spline_surfaces(reader);
  auto all = read_b_spline_surfaces(reader, instances);
  std::vector<ReadSurface> read;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k]) {
      data->surface_instances.push_back(instances[k]);
      read.push_back(*std::move(all[k]));
    } else {
      data->unreadable.push_back(
          {"#" + std::to_string(data->records.instance(instances[k]).id), std::move(all[k].error())});
    }
  }

  const auto contexts = read_unit_contexts(reader);
  data->units.reserve(contexts.size());
  for (const auto& context : contexts) data->units.push_back(context.unit);
  const auto context_of = contexts_of(reader, contexts, data->surface_instances);
  std::vector<double> uncertainty;
  uncertainty.reserve(context_of.size());
  for (const int context : context_of) {
    uncertainty.push_back(context < 0 ? 0 : contexts[static_cast<std::size_t>(context)].uncertainty);
  }
  const auto uses = face_uses(reader, read, uncertainty);
  const bool one_unit = std::all_of(contexts.begin(), contexts.end(), [&](const UnitContext& context) {
    return context.unit.name == contexts.front().unit.name;
  });
  // What is not reached from any representation still has the file's unit if there is only one.
  const auto unit_in = [&](int context) {
    if (context >= 0) return contexts[static_cast<std::size_t>(context)].unit.name;
    return !contexts.empty() && one_unit ? contexts.front().unit.name : std::string("unknown");
  };
  const auto surfaces = std::make_shared<std::vector<SurfaceEntity>>();
  surfaces->reserve(read.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    const auto id = "#" + std::to_string(data->records.instance(read[k].instance).id);
    data->surface_index.emplace(id, k);
    surfaces->push_back({id,
                         reader.item_name(read[k].instance),
                         unit_in(context_of[k]),
                         std::move(read[k].surface),
                         {},
                         uses[k].trimmed,
                         uses[k].faces});
  }
  share(reader, surfaces->size(), [&](const Reader&, std::size_t k) {
    SurfaceEntity& surface = (*surfaces)[k];
    surface.closed = closed_directions(surface.surface);
  });
  data->surfaces = surfaces;
  std::vector<ReadCurve> curves = free_curves(reader);
  for (const ReadCurve& c : curves) data->curve_instances.push_back(c.instance);
  const auto context_of_curve = contexts_of(reader, contexts, data->curve_instances);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    data->curve_point_refs.push_back(std::move(curves[k].references));
    data->curves.push_back({"#" + std::to_string(data->records.instance(curves[k].instance).id),
                            reader.item_name(curves[k].instance), unit_in(context_of_curve[k]),
                            std::move(curves[k].curve)});
  }
  data->instances = read_instances(reader);
  return File(std::move(data));
}

const std::string& File::name() const { return data_->records.name(); }
const std::string& File::bytes() const { return data_->records.bytes(); }
const std::string& File::schema() const { return data_->schema; }
const std::vector<SurfaceEntity>& File::surfaces() const { return *data_->surfaces; }
const std::vector<UnreadableSurface>& File::unreadable_surfaces() const { return data_->unreadable; }
const std::vector<CurveEntity>& File::curves() const { return data_->curves; }
const std::vector<Instance>& File::instances() const { return data_->instances; }
const std::vector<LengthUnit>& File::length_units() const { return data_->units; }

std::string File::length_unit() const {
  std::vector<std::string> names;
  for (const auto& unit : data_->units) {
    if (std::find(names.begin(), names.end(), unit.name) == names.end()) names.push_back(unit.name);
  }
  if (names.empty()) return "unknown";
  std::string result = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) result += ", " + names[k];
  return result;
}

std::vector<Error> File::warnings() const {
  const auto& dangling = data_->records.dangling();
  std::vector<Error> result;
  for (const auto& [place, id, byte] : dangling) {
    result.push_back({ErrorKind::input, "it refers to #" + std::to_string(id) + ", which the file does not define",
                      place, "check that the file is complete", name(), data_->records.line(byte)});
  }
  const std::size_t others = data_->records.dangling_count() - dangling.size();
  if (others > 0) {
    result.push_back({ErrorKind::input,
                      std::to_string(others) + " other references lead to nothing",
                      {},
                      "check that the file is complete",
                      name()});
  }
  return result;
}

bool File::is_bound_curve(const std::string& id) const {
  std::uint64_t number = 0;
  const char* const end = id.data() + id.size();
  if (id.size() < 2 || id[0] != '#' || std::from_chars(id.data() + 1, end, number).ptr != end) return false;
  const auto instance = data_->records.find(number);
  return instance && is_b_spline_curve(Reader(data_->records), *instance) &&
         std::ranges::find(data_->curve_instances, *instance) == data_->curve_instances.end();
}

const SurfaceEntity* File::find_surface(const std::string& id) const {
  const auto found = data_->surface_index.find(id);
  return found == data_->surface_index.end() ? nullptr : &(*data_->surfaces)[found->second];
}

}  // namespace knead::step
