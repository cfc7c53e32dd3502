#pragma once

#include "knead/session/session.hpp"
#include "morph_fields.hpp"

namespace knead {

/// The file that has followed data, and the report of it.
struct MorphAnswer {
  Bytes file;
  MorphReport report;
  std::string page;  ///< Markdown
};
void describe(MorphAnswer& a, Fields& fields);

/// `morph_file` of a document as it would be saved. The document stays as it is.
struct MorphQuery {
  using Answer = MorphAnswer;
  AskedData data;
  MorphRequest request;
};
void describe(MorphQuery& q, Fields& fields);

/// Errors: those of saving the document, and of `morph_file`; (usage) not one kind of data;
/// (numerical) something above what was wanted, if `strict`. Cost: that of saving it and of
/// `morph_file`.
[[nodiscard]] Expected<MorphAnswer> ask(const Session& session, const MorphQuery& q);

}  // namespace knead
