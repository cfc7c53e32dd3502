#pragma once

#include "describe/bytes.hpp"
#include "knead/exchange/morph.hpp"
#include "knead/session/session.hpp"

namespace knead {

/// The file that has followed data, and the report of it.
struct MorphAnswer {
  Bytes file;
  MorphReport report;
};
void describe(MorphAnswer& a, Fields& fields);

/// `morph_file` of a document as it would be saved. The document stays as it is.
struct MorphQuery {
  using Answer = MorphAnswer;
  std::string space;
  Bytes vectors, from, to, scan;  ///< files; empty: none
  MorphSettings settings;
  std::optional<std::string> along;  ///< "normal"
  bool strict = false;               ///< what is above what was wanted is an error
};
void describe(MorphQuery& q, Fields& fields);

/// Errors: those of saving the document, and of `morph_file`; (usage) not one kind of data;
/// (numerical) something above what was wanted, if `strict`. Cost: that of saving it and of
/// `morph_file`.
[[nodiscard]] Expected<MorphAnswer> ask(const Session& session, const MorphQuery& q);

}  // namespace knead
