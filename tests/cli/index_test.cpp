// What `knead info --json` says of the files of a collection, beside an index of them that another
// reader made.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "knead/exchange/file_io.hpp"
#include "program.hpp"
#include "support/foreign_files.hpp"

namespace knead::testing {
namespace {

using Record = std::map<std::string, std::string>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

std::vector<Record> index() {
  std::vector<Record> records;
  const auto bytes = read_file(foreign_cad("INDEX.csv"));
  if (!bytes) return records;
  std::istringstream text(*bytes);
  std::string line;
  std::vector<std::string> names;
  while (std::getline(text, line)) {
    const auto cells = cells_of(line);
    if (names.empty()) {
      names = cells;
      continue;
    }
    Record record;
    for (std::size_t k = 0; k < names.size() && k < cells.size(); ++k) record[names[k]] = cells[k];
    records.push_back(std::move(record));
  }
  return records;
}

/// The unit in the words of the index: the file's own name of it, or several where a file has
/// several contexts.
bool same_unit(const std::string& indexed, const std::string& unit) {
  if (indexed.empty() || indexed == "?" || indexed.starts_with("none")) return unit == "unknown";
  static const std::map<std::string, std::string> words = {
      {"mm", "MM"}, {"cm", "CM"}, {"m", "M"}, {"inch", "IN"}, {"foot", "FOOT"}};
  const auto word = words.find(unit);
  if (word == words.end()) return false;
  std::istringstream parts(indexed);
  for (std::string part; std::getline(parts, part, ',');) {
    if (part.starts_with(word->second) &&
        (part.size() == word->second.size() || word->second == "IN"))
      return true;
  }
  return false;
}

std::string by(const Json& pair, char between) {
  const auto word = [](const Json& value) {
    return value.is_boolean() ? std::string(value.get<bool>() ? "True" : "False") : value.dump();
  };
  return word(pair[0]) + between + word(pair[1]);
}

/// How often a surface is shown: once per face and place of its part.
int shown(const Json& info, const Json& surface) {
  int places = 0;
  for (const Json& part : info.at("assembly").at("parts")) {
    const Json& surfaces = part.at("surfaces");
    if (std::ranges::find(surfaces, surface.at("id")) != surfaces.end()) {
      places += static_cast<int>(part.at("places").size());
    }
  }
  return surface.at("faces").get<int>() * std::max(places, 1);
}

void compare(const Record& record, const Json& info) {
  const Json& surfaces = info.at("surfaces");
  const auto number = [&](const char* field) { return std::stod(record.at(field)); };
  const auto stated = [&](const char* field) {
    return record.contains(field) && !record.at(field).empty();
  };
  if (stated("raw_bspline_surfaces")) {
    EXPECT_EQ(surfaces.size(), static_cast<std::size_t>(number("raw_bspline_surfaces")));
  }
  EXPECT_TRUE(same_unit(record.at("units"), info.at("units")))
      << record.at("units") << " " << info.at("units");
  if (surfaces.empty() || !stated("max_degree")) return;

  int degree = 0, rational = 0, unclamped = 0, faces = 0, trimmed = 0;
  double least = 1, most = 1;
  const bool brep = info.at("format") == "Open CASCADE";
  for (const Json& s : surfaces) {
    degree = std::max({degree, s.at("degree")[0].get<int>(), s.at("degree")[1].get<int>()});
    // Weights that are all equal make no rational surface: the index does not count them, `info`
    // says what is written.
    if (!s.at("weights").is_null()) {
      EXPECT_TRUE(s.at("rational"));
      const double low = s.at("weights")[0], high = s.at("weights")[1];
      rational += low < high ? 1 : 0;
      least = std::min(least, low);
      most = std::max(most, high);
    }
    unclamped += s.at("clamped")[0].get<bool>() && s.at("clamped")[1].get<bool>() ? 0 : 1;
    if (s.at("faces").is_null()) continue;
    faces += shown(info, s);
    if (s.at("trimmed").get<bool>()) trimmed += shown(info, s);
  }
  EXPECT_EQ(degree, number("max_degree"));
  EXPECT_EQ(rational, number("n_rational"));
  EXPECT_EQ(unclamped, number("n_unclamped"));
  if (stated("max_weight")) {
    EXPECT_NEAR(std::max(most, 1.0), std::max(number("max_weight"), 1.0), 1e-12 * most);
    EXPECT_NEAR(std::min(least, 1.0), std::min(number("min_weight"), 1.0), 1e-11);
  }
  if (stated("occt_bspline_faces") && faces > 0) {
    EXPECT_EQ(faces, number("occt_bspline_faces"));
  }
  // Three faces of this one end 6 µm inside their surfaces, which is less than its edges are off.
  const bool off = record.at("file") == "MAINBODY_BACK.stp";
  if (stated("occt_trimmed_faces") && faces > 0 && !brep) {
    EXPECT_EQ(trimmed + (off ? 3 : 0), number("occt_trimmed_faces"));
  }
  // The largest surface: several may be as large.
  if (!stated("big_net")) return;
  const bool found = std::ranges::any_of(surfaces, [&](const Json& s) {
    const std::string clamped = by(s.at("clamped"), ',');
    const bool really = !s.at("weights").is_null() && s.at("weights")[0] < s.at("weights")[1];
    const std::string indexed = record.at("big_clamped");
    return by(s.at("net"), 'x') == record.at("big_net") &&
           by(s.at("degree"), 'x') == record.at("big_degree") &&
           (really ? "True" : "False") == record.at("big_rational") &&
           by(s.at("max_interior_multiplicity"), 'x') == record.at("big_max_interior_mult") &&
           by(s.at("closed"), '/') == record.at("big_closed") &&
           (indexed == "[" + clamped.substr(0, clamped.find(',')) + ", " +
                           clamped.substr(clamped.find(',') + 1) + "]" ||
            (indexed == "True" && clamped == "True,True"));
  });
  EXPECT_TRUE(found) << "the largest surface: " << record.at("big_net") << " "
                     << record.at("big_degree");
}

TEST(Index, OfForeignFilesAgreesWithInfo) {
  KNEAD_NEEDS(foreign_cad("INDEX.csv"));
  const auto records = index();
  int compared = 0;
  for (const Record& record : records) {
    const std::string& file = record.at("file");
    if (file.ends_with(".3dm")) continue;
    SCOPED_TRACE(file);
    const Outcome run = knead({"info", "--json", foreign_cad(file).string()});
    ASSERT_EQ(run.code, 0) << run.err;
    const Json info = run.json();
    ++compared;
    if (file == "smesh.45.in.dat") {  // the reader of the index did not read this one
      EXPECT_EQ(info.at("surfaces").size(), 1U);
    } else if (file == "duck1.ctrlpts") {  // nothing says how many points make a row
      EXPECT_EQ(info.at("format"), "plain net");
      ASSERT_EQ(info.at("unreadable_surfaces").size(), 1U);
      const std::string reason = info.at("unreadable_surfaces")[0].at("reason");
      EXPECT_NE(reason.find("182 control points"), std::string::npos) << reason;
    } else {
      EXPECT_TRUE(info.at("unreadable_surfaces").empty());
      compare(record, info);
    }
  }
  EXPECT_EQ(compared, 34);
}

}  // namespace
}  // namespace knead::testing
