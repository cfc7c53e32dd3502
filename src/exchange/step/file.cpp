#include "file.hpp"

#include <algorithm>
#include <charconv>

#include "data.hpp"
#include "entity.hpp"
#include "exchange/part21/part21_text.hpp"
#include "free_curves.hpp"
#include "knead/exchange/file_io.hpp"

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
  auto model = read_model(reader, data->of);
  if (!model) return std::unexpected(std::move(model.error()));
  data->model = std::make_shared<const brep::Model>(*std::move(model));
  return File(std::move(data));
}

const std::string& File::name() const { return data_->records.name(); }
const std::string& File::bytes() const { return data_->records.bytes(); }
const std::string& File::schema() const { return data_->schema; }
const brep::Model& File::model() const { return *data_->model; }
std::shared_ptr<const brep::Model> File::shared_model() const { return data_->model; }

std::vector<Error> File::warnings() const {
  const auto& dangling = data_->records.dangling();
  std::vector<Error> result;
  for (const auto& [place, id, byte] : dangling) {
    result.push_back({ErrorKind::input,
                      "it refers to #" + std::to_string(id) + ", which the file does not define",
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
  if (id.size() < 2 || id[0] != '#' || std::from_chars(id.data() + 1, end, number).ptr != end)
    return false;
  const auto instance = data_->records.find(number);
  return instance && is_b_spline_curve(Reader(data_->records), *instance) &&
         std::ranges::find(data_->of.curves, *instance) == data_->of.curves.end();
}

}  // namespace knead::step
