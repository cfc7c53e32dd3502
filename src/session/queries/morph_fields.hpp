#pragma once

#include <optional>
#include <string>

#include "describe/bytes.hpp"
#include "describe/describe.hpp"
#include "exchange/morph/moving_model.hpp"
#include "knead/exchange/morph.hpp"

namespace knead {

/// How surfaces follow data, as a command and a query are asked.
struct MorphRequest {
  std::string space;  ///< the displacement as three formulas; empty: a file says it
  MorphSettings settings;
  std::optional<std::string> along;  ///< "normal"
  bool strict = false;               ///< what is above what was wanted is an error
  detail::MorphHolds holds = {};     ///< what surfaces of the scene keep
};

/// The data as a query is asked: files; empty: none.
struct AskedData {
  Bytes vectors, from, to, scan;
};

/// The map of space, and the files.
void describe_data(std::string& space, AskedData& data, Fields& fields);

/// These, and the map of space.
[[nodiscard]] MorphData data_of(const AskedData& asked, const std::string& space);

/// Whether one kind of data is given. Errors (usage): none, several, half a pair of meshes.
[[nodiscard]] Expected<void> check_kinds(const MorphData& data);

/// The fields that say which points of the faces data are about.
void describe_partners(MorphRequest& request, Fields& fields);

/// These, and how they are followed: all but `space`, which comes before the fields of files.
void describe_following(MorphRequest& request, Fields& fields);

/// `morph_file` of a file by one kind of data. Errors: (usage) not one kind of data; (numerical)
/// something above what was wanted, if `strict`; those of `morph_file`.
[[nodiscard]] Expected<MorphedFile> follow_data(const std::shared_ptr<const Source>& source,
                                                MorphData data, const MorphRequest& request,
                                                const MorphTold& told = {});

}  // namespace knead
